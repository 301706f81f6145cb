// SPDX-License-Identifier: BSD-3-Clause
// Uniaxial and equibiaxial stress-stretch curves of the Fung bond against the continuum (Cauchy-Born).
//
// In a body that deforms by F everywhere a bond of direction n has s = |F n| - 1, and
//   W(F) = 1/2 int w dV = c delta^4 / 8 int over the sphere of phi(s) dn,  phi = (exp(a s^2) - 1) / (2 a).
// For F = diag(lateral, lateral, axial), and with Eq. (4)'s c, that is 6 E int_0^1 phi(s(mu)) dmu. The
// engine's stresses are difference quotients of the energy of a particle whose family is whole. What is left
// between them is the error of a sum over a cubic lattice in place of the integral: it falls with the horizon
// ratio.
#include <gtest/gtest.h>

#include "support/vessels.hpp"

namespace rhexis::peridynamics {
namespace {

constexpr double exponent = 10, young = 3.5e6;

struct Stretches {
  double axial, lateral;
};

/// dW/d(axial) and dW/d(lateral), the latter for both lateral directions together, Pa.
Stretches continuum_stress(Stretches f) {
  const int intervals = 200;  // Simpson; the integrand is smooth
  Stretches sum{0, 0};
  for (int i = 0; i <= intervals; ++i) {
    const double mu = static_cast<double>(i) / intervals;
    const double length = std::hypot(f.axial * mu, f.lateral * std::sqrt(1 - mu * mu));
    const double s = length - 1;
    const double weight = (i == 0 || i == intervals ? 1 : i % 2 == 1 ? 4 : 2) / (3.0 * intervals);
    const double slope = 6 * young * weight * s * std::exp(exponent * s * s) / length;
    sum.axial += slope * f.axial * mu * mu;
    sum.lateral += slope * f.lateral * (1 - mu * mu);
  }
  return sum;
}

/// `free` such that the stress that `component` picks vanishes.
template <class WithFree>
Stretches unloaded(const WithFree& with_free, double Stretches::*component) {
  double low = 0.5, high = 1.5;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (continuum_stress(with_free(middle)).*component > 0 ? high : low) = middle;
  }
  return with_free(low);
}

/// A rod whose middle has whole families.
class Rod {
 public:
  Rod(double horizon_ratio, bool double_bonds) {
    Parameters p = test::paper_vessel();
    p.law.name = "fung";
    p.law.numbers["fung_exponent"] = exponent;
    p.critical_stretch = 0.9;
    p.ends = EndCondition::free;
    p.inner_radius = 1e-6;
    p.horizon = horizon_ratio * *p.spacing;
    p.outer_radius = (horizon_ratio + 1) * *p.spacing;
    p.length = (2 * std::ceil(horizon_ratio) + 1) * *p.spacing;
    p.bond_precision = double_bonds ? Precision::double_precision : Precision::single_precision;
    setup_ = test::setup_of(p, 1e-7);
    body_ = make_body(BodySetup(setup_), test::self());
    const CrossSection& s = setup_.lattice.section;
    for (std::size_t c = 1; c < s.size(); ++c) {
      if (std::hypot(s.x[c], s.y[c]) < std::hypot(s.x[middle_], s.y[middle_])) middle_ = c;
    }
  }

  /// Strain energy density of the particle in the middle, J/m3.
  double energy(Stretches f) const {
    body_->set_state(
        test::sample(
            *body_,
            [&](auto x) {
              return std::array{(f.lateral - 1) * x[0], (f.lateral - 1) * x[1], (f.axial - 1) * x[2]};
            }),
        test::sample(*body_, test::nothing));
    const std::int64_t rows = body_->columns()->rows;
    return body_->observe(0)
        .strain_energy_density[middle_ * static_cast<std::size_t>(rows) + static_cast<std::size_t>(rows / 2)];
  }

  /// The same summed here, bond by bond.
  double summed_energy(Stretches f) const {
    double sum = 0;
    for (std::int64_t b = setup_.families->first[middle_]; b < setup_.families->first[middle_ + 1]; ++b) {
      const Bond& bond = setup_.families->bonds[b];
      const double s =
          std::hypot(f.lateral * bond.xi[0], f.lateral * bond.xi[1], f.axial * bond.xi[2]) / bond.length - 1;
      sum += bond.length * std::expm1(exponent * s * s) / (2 * exponent);
    }
    return 0.5 * setup_.bond_constant * std::pow(setup_.lattice.spacing, 4) * sum;
  }

  Stretches stress(Stretches f) const {
    const double h = 1e-4;
    return {(energy({f.axial + h, f.lateral}) - energy({f.axial - h, f.lateral})) / (2 * h),
            (energy({f.axial, f.lateral + h}) - energy({f.axial, f.lateral - h})) / (2 * h)};
  }

 private:
  BodySetup setup_;
  std::unique_ptr<Body> body_;
  std::size_t middle_ = 0;
};

/// Curves of a bar under uniaxial stress and of a sheet under equibiaxial stress.
std::vector<Stretches> uniaxial(std::initializer_list<double> stretches) {
  std::vector<Stretches> curve;
  for (double x : stretches)
    curve.push_back(unloaded([&](double free) { return Stretches{x, free}; }, &Stretches::lateral));
  return curve;
}
std::vector<Stretches> biaxial(std::initializer_list<double> stretches) {
  std::vector<Stretches> curve;
  for (double x : stretches)
    curve.push_back(unloaded([&](double free) { return Stretches{free, x}; }, &Stretches::axial));
  return curve;
}

TEST(FungCurves, SmallStrainIsYoungsModulus) {
  const Stretches f = uniaxial({1.0001}).front();
  EXPECT_NEAR(continuum_stress(f).axial / (young * 1e-4), 1, 1e-3);
  EXPECT_NEAR((f.lateral - 1) / -1e-4, 0.25, 1e-3);
}

TEST(FungCurves, EngineSumsItsFamily) {
  for (bool doubles : {false, true}) {
    const Rod rod(3.5, doubles);
    for (Stretches f : {Stretches{1.001, 1}, Stretches{1.3, 0.95}, Stretches{0.9, 1.2}}) {
      EXPECT_NEAR(rod.energy(f) / rod.summed_energy(f), 1, doubles ? 1e-10 : 3e-4);
    }
  }
}

struct Error {
  double horizon_ratio, uniaxial, biaxial;  ///< largest relative error of the stress on the curve
};

class FungLattice : public testing::TestWithParam<Error> {};
INSTANTIATE_TEST_SUITE_P(HorizonRatios, FungLattice,
                         testing::Values(Error{3.015, 0.0082, 0.0553}, Error{3.5, 0.0526, 0.0115},
                                         Error{5, 0.0539, 0.0345}, Error{7, 0.0283, 0.0223}));

TEST_P(FungLattice, IsAsFarFromTheContinuumAsStated) {
  const Rod rod(GetParam().horizon_ratio, true);
  double off_uniaxial = 0, off_biaxial = 0;
  for (Stretches f : uniaxial({0.9, 1.05, 1.1, 1.2, 1.3})) {
    off_uniaxial = std::max(off_uniaxial, std::abs(rod.stress(f).axial / continuum_stress(f).axial - 1));
  }
  for (Stretches f : biaxial({0.9, 1.05, 1.1, 1.2, 1.3})) {
    off_biaxial = std::max(off_biaxial, std::abs(rod.stress(f).lateral / continuum_stress(f).lateral - 1));
  }
  std::printf("horizon of %.3f spacings: stress off by %.4f (uniaxial), %.4f (biaxial)\n",
              GetParam().horizon_ratio, off_uniaxial, off_biaxial);
  EXPECT_NEAR(off_uniaxial, GetParam().uniaxial, 0.002);
  EXPECT_NEAR(off_biaxial, GetParam().biaxial, 0.002);
}

}  // namespace
}  // namespace rhexis::peridynamics
