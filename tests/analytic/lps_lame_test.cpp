// The linear peridynamic solid against Lame at several Poisson's ratios, polar cross-section, families of 3.5
// spacings, consistent load in a layer of one horizon, no surface correction. Surfaces dominate in a wall of
// 5 spacings. Relative L2 errors of the radial displacement over the wall, and with m of each particle's own
// family in place of pi delta^4 (rings of columns solved directly; the same numbers as here at 5 spacings):
//
//   spacings across the wall          5                 10                20                40
//   nu = 0.25                  13.5 % (18.3 %)    4.6 % (11.3 %)    3.4 % ( 5.4 %)    1.0 % (3.8 %)
//   nu = 0.40                   7.1 % (25.8 %)    1.1 % (16.2 %)    1.6 % ( 8.0 %)    0.3 % (5.5 %)
//   nu = 0.49                   7.9 % (34.7 %)    8.4 % (24.1 %)    3.9 % (13.1 %)    3.2 % (8.3 %)
//
// Families cut off at surfaces make the wall too soft, and their missing dilatation too stiff as nu grows:
// errors that partly cancel.
#include "support/lame.hpp"

namespace rhexis::peridynamics {
namespace {

struct Case {
  double poisson_ratio, error;
};

class LpsLame : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(PoissonRatios, LpsLame,
                         testing::Values(Case{0.25, 0.1345}, Case{0.4, 0.0705}, Case{0.49, 0.0795}));

TEST_P(LpsLame, PlaneStrainErrorIsTheStatedOne) {
  Parameters p = test::paper_vessel(8e-4);
  p.law.name = "lps";
  p.law.poisson_ratio = GetParam().poisson_ratio;
  p.cross_section = "polar";
  p.layer = "consistent";
  const double error = test::lame_error(p, 500, 900);
  std::printf("nu = %.2f: relative L2 error %.4f\n", p.law.poisson_ratio, error);
  EXPECT_NEAR(error, GetParam().error, 0.002);
}

}  // namespace
}  // namespace rhexis::peridynamics
