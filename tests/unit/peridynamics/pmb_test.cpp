// Eqs. (2)-(5): the law alone, against closed forms in long double.
#include "peridynamics/materials/pmb.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace rhexis::peridynamics {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class Real>
Real force_factor(Real t) {
  const hn::CappedTag<Real, 1> d;
  return hn::GetLane(Pmb::force_factor(d, hn::Set(d, t)));
}

template <class Real>
Real energy_factor(Real t) {
  const hn::CappedTag<Real, 1> d;
  return hn::GetLane(Pmb::energy_factor(d, hn::Set(d, t)));
}

/// t of a stretch s, in the precision of the kernel.
template <class Real>
Real t_of(long double s) {
  return static_cast<Real>(s * (2 + s));
}

const std::vector<long double> stretches = {-0.9L, -0.5L, -0.1L, -1e-3L, -1e-5L, 1e-5L,
                                            1e-3L, 0.05L, 0.1L,  0.25L,  2.0L};

TEST(Pmb, BondConstantMatchesBulkModulus) {
  const double young = 3.5e6, horizon = 350e-6;
  const double bulk = young / (3 * (1 - 2 * 0.25));
  EXPECT_NEAR(Pmb::bond_constant(young, horizon) / (18 * bulk / (std::numbers::pi * std::pow(horizon, 4))), 1,
              1e-14);
}

TEST(Pmb, ForceFactorIsStretchOverOnePlusStretch) {
  for (long double s : stretches) {
    const auto t64 = t_of<double>(s);
    const long double exact64 = 1 - 1 / std::sqrt(1 + static_cast<long double>(t64));
    EXPECT_NEAR(force_factor(t64) / static_cast<double>(exact64), 1, 4e-15)
        << "s = " << static_cast<double>(s);
    // Single precision: as the header promises.
    const auto t32 = t_of<float>(s);
    const long double exact32 = 1 - 1 / std::sqrt(1 + static_cast<long double>(t32));
    EXPECT_NEAR(force_factor(t32), static_cast<double>(exact32),
                1e-6 * std::abs(static_cast<double>(exact32)) + 5e-11)
        << "s = " << static_cast<double>(s);
  }
}

TEST(Pmb, ForceIsTheDerivativeOfTheEnergy) {
  // dw/d|y| = c s with w = c |xi| s^2/2: in terms of t, d(s^2/2)/ds = s = g (1 + s).
  for (long double s : stretches) {
    const double h = 1e-6;
    const double slope = (energy_factor(t_of<double>(s + h)) - energy_factor(t_of<double>(s - h))) / (2 * h);
    EXPECT_NEAR(slope, force_factor(t_of<double>(s)) * (1 + static_cast<double>(s)), 1e-9);
  }
}

TEST(Pmb, BreakingTestEqualsTheStretchTest) {
  EXPECT_DOUBLE_EQ(Pmb::breaking_t(0.25), 1.25 * 1.25 - 1);
}

TEST(Pmb, EnergyReleaseRateIsTheEnergyOfTheBondsThatCrossAPlane) {
  // Bonds of a cubic lattice of step 1: of each offset (i, j, k), k of them cross a unit of the plane z = 0.
  const int horizon = 20;
  const double young = 3.5e6, stretch = 0.25;
  const double c = Pmb::bond_constant(young, horizon);
  double energy = 0;
  for (int i = -horizon; i <= horizon; ++i) {
    for (int j = -horizon; j <= horizon; ++j) {
      for (int k = 1; k <= horizon; ++k) {
        const double length = std::sqrt(i * i + j * j + k * k);
        if (length <= horizon) energy += k * c * stretch * stretch * length / 2;
      }
    }
  }
  const double rate = Pmb::energy_release_rate(young, horizon, stretch);
  EXPECT_NEAR(energy / rate, 1, 0.01);
  EXPECT_NEAR(rate / (1.2 * young * stretch * stretch * horizon), 1, 1e-14);
  EXPECT_NEAR(Pmb::critical_stretch(young, horizon, rate) / stretch, 1, 1e-14);
}

TEST(Pmb, CoincidentParticlesHaveAFiniteForce) {
  EXPECT_TRUE(std::isfinite(force_factor(-1.0f)));
  EXPECT_TRUE(std::isfinite(force_factor(-1.0)));
}

}  // namespace
}  // namespace rhexis::peridynamics
