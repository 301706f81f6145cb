// SPDX-License-Identifier: BSD-3-Clause
// Eqs. (2)-(5): the law alone, as a scalar and as the kernel's vectors, against closed forms in long double.
#include "peridynamics/laws/pmb.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/laws.hpp"

namespace rhexis::peridynamics {
namespace {

using test::stretches;
using test::t_of;

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
    EXPECT_NEAR(test::force_factor(Pmb{}, t64) / static_cast<double>(exact64), 1, 4e-15)
        << "s = " << static_cast<double>(s);
    EXPECT_EQ(Pmb::force_factor(t64), test::force_factor(Pmb{}, t64)) << "one law for scalars and vectors";
    // Single precision: as the header promises.
    const auto t32 = t_of<float>(s);
    const long double exact32 = 1 - 1 / std::sqrt(1 + static_cast<long double>(t32));
    EXPECT_NEAR(test::force_factor(Pmb{}, t32), static_cast<double>(exact32),
                1e-6 * std::abs(static_cast<double>(exact32)) + 5e-11)
        << "s = " << static_cast<double>(s);
    EXPECT_NEAR(Pmb::force_factor(t32), static_cast<double>(exact32),
                1e-6 * std::abs(static_cast<double>(exact32)));
  }
}

TEST(Pmb, ForceIsTheDerivativeOfTheEnergy) {
  // dw/d|y| = c s with w = c |xi| s^2/2: in terms of t, d(s^2/2)/ds = s = g (1 + s).
  for (long double s : stretches) {
    const double h = 1e-6;
    const double slope =
        (test::energy_factor(Pmb{}, t_of<double>(s + h)) - test::energy_factor(Pmb{}, t_of<double>(s - h))) /
        (2 * h);
    EXPECT_NEAR(slope, test::force_factor(Pmb{}, t_of<double>(s)) * (1 + static_cast<double>(s)), 1e-9);
  }
}

TEST(Pmb, BreakingTestEqualsTheStretchTest) {
  EXPECT_DOUBLE_EQ(t_of_stretch(0.25), 1.25 * 1.25 - 1);
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
  EXPECT_TRUE(std::isfinite(test::force_factor(Pmb{}, -1.0f)));
  EXPECT_TRUE(std::isfinite(test::force_factor(Pmb{}, -1.0)));
}

}  // namespace
}  // namespace rhexis::peridynamics
