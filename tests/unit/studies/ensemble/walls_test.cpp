// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/error.hpp"
#include "support/vessels.hpp"

namespace rhexis::ensemble {
namespace {

const Parameters scattered{
    .samples = 20000, .seed = 3, .strength_spread = 0.15, .thickness_spread = 0.05, .stiffness_spread = 0.3};

peridynamics::Parameters mean_vessel() {
  peridynamics::Parameters v = test::paper_vessel();
  peridynamics::resolve(v);
  return v;
}

TEST(Walls, AWallIsAFunctionOfSeedAndNumber) {
  Parameters more = scattered;
  more.samples = 5;
  more.pressures = {1e4};
  EXPECT_EQ(draw_wall(scattered, 3), draw_wall(more, 3));
  EXPECT_NE(draw_wall(scattered, 3), draw_wall(scattered, 4));
  more.seed = 4;
  EXPECT_NE(draw_wall(scattered, 3), draw_wall(more, 3));
  // One spread does not change what the others draw.
  more = scattered;
  more.strength_spread = 0;
  EXPECT_EQ(draw_wall(more, 3).strength, 1);
  EXPECT_EQ(draw_wall(more, 3).thickness, draw_wall(scattered, 3).thickness);
}

TEST(Walls, FactorsHaveMeanOneTheirSpreadsAndNoCorrelation) {
  const std::pair<double, std::function<double(const SampledWall&)>> kinds[] = {
      {0.15, [](const SampledWall& f) { return f.strength; }},
      {0.05, [](const SampledWall& f) { return f.thickness; }},
      {0.3, [](const SampledWall& f) { return f.stiffness; }}};
  double sum[3] = {}, products[3][3] = {};
  const auto n = static_cast<double>(scattered.samples);
  for (std::int64_t i = 0; i < scattered.samples; ++i) {
    const SampledWall f = draw_wall(scattered, i);
    for (int a = 0; a < 3; ++a) {
      sum[a] += kinds[a].second(f);
      for (int b = 0; b < 3; ++b)
        products[a][b] +=
            (kinds[a].second(f) - 1) * (kinds[b].second(f) - 1) / (kinds[a].first * kinds[b].first);
    }
  }
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(sum[a] / n, 1, 5 * kinds[a].first / std::sqrt(n)) << a;
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(products[a][b] / n, a == b ? 1 : 0, 0.06) << a << b;
  }
}

TEST(Walls, WithoutSpreadAWallIsTheMeanToTheLastBit) {
  const peridynamics::Parameters v = mean_vessel(), same = with_wall(v, draw_wall({.seed = 9}, 17));
  EXPECT_EQ(same.outer_radius, v.outer_radius);
  EXPECT_EQ(same.critical_stretch, v.critical_stretch);
  EXPECT_EQ(same.young_modulus, v.young_modulus);
}

TEST(Walls, FactorsChangeTheirPropertyAlone) {
  const peridynamics::Parameters v = mean_vessel();
  const peridynamics::Parameters w = with_wall(v, {.strength = 0.5, .thickness = 1.2, .stiffness = 2});
  EXPECT_DOUBLE_EQ(*w.critical_stretch, 0.5 * *v.critical_stretch);
  EXPECT_DOUBLE_EQ(w.young_modulus, 2 * v.young_modulus);
  EXPECT_DOUBLE_EQ(w.outer_radius - w.inner_radius, 1.2 * (v.outer_radius - v.inner_radius));
  EXPECT_EQ(w.inner_radius, v.inner_radius);
  EXPECT_EQ(w.spacing, v.spacing);
  EXPECT_EQ(w.horizon, v.horizon);
}

TEST(Walls, TooThinForTheSpacingIsRefusedOrWarnedOf) {
  peridynamics::Parameters v = mean_vessel();  // five spacings thick
  v.cross_section = peridynamics::Arrangement::polar;
  Parameters p{.samples = 1000, .seed = 1, .thickness_spread = 0.05};
  EXPECT_TRUE(check_walls(p, v).empty());
  p.thickness_spread = 0.2;
  const auto warnings = check_walls(p, v);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("of 1000 walls"), std::string::npos);
  v.cross_section = peridynamics::Arrangement::lattice;
  EXPECT_EQ(check_walls(p, v).size(), 2u);
  p.thickness_spread = 1;
  EXPECT_THROW(check_walls(p, v), InputError);
}

}  // namespace
}  // namespace rhexis::ensemble
