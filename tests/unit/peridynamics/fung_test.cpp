// SPDX-License-Identifier: BSD-3-Clause
// The stiffening bond alone, against its closed forms in long double.
#include "peridynamics/laws/fung.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/laws.hpp"

namespace rhexis::peridynamics {
namespace {

using test::stretches;
using test::t_of;

const std::vector<double> exponents = {1e-3, 1, 10, 40};

/// Stretch that the kernel means by its t.
template <class Real>
long double s_of(Real t) {
  return std::sqrt(1 + static_cast<long double>(t)) - 1;
}

TEST(Fung, ForceFactorIsPmbsTimesTheExponential) {
  for (double a : exponents) {
    for (long double stretch : stretches) {
      if (a * stretch * stretch > 50) continue;
      const auto exact = [&](long double s) {
        return static_cast<double>(s / (1 + s) * std::exp(a * s * s));
      };
      const auto t64 = t_of<double>(stretch);
      const double q = static_cast<double>(a * stretch * stretch);
      EXPECT_NEAR(test::force_factor(Fung{a}, t64) / exact(s_of(t64)), 1, 4e-15 * (1 + 4 * q))
          << "a = " << a << ", s = " << static_cast<double>(stretch);
      EXPECT_NEAR(Fung{a}.force_factor(t64) / exact(s_of(t64)), 1, 4e-15 * (1 + 4 * q));
      // In single precision the error of s^2, 4e-6 at most, is multiplied by a.
      const auto t32 = t_of<float>(stretch);
      const double f = exact(s_of(t32));
      EXPECT_NEAR(test::force_factor(Fung{a}, t32), f, 1e-6 * (1 + 4 * q) * std::abs(f) + 5e-11)
          << "a = " << a << ", s = " << static_cast<double>(stretch);
    }
  }
}

TEST(Fung, EnergyHasNoCancellationAtSmallStretch) {
  for (double a : exponents) {
    for (long double stretch : stretches) {
      if (a * stretch * stretch > 50) continue;
      const auto t64 = t_of<double>(stretch);
      const auto t32 = t_of<float>(stretch);
      const auto exact = [&](long double s) { return static_cast<double>(std::expm1(a * s * s) / (2 * a)); };
      const double q = static_cast<double>(a * stretch * stretch);
      EXPECT_NEAR(test::energy_factor(Fung{a}, t64) / exact(s_of(t64)), 1, 2e-14 * (1 + q));
      EXPECT_NEAR(Fung{a}.energy_factor(t64) / exact(s_of(t64)), 1, 2e-14 * (1 + q));
      const double w = exact(s_of(t32));
      EXPECT_NEAR(test::energy_factor(Fung{a}, t32), w, 1e-5 * (1 + q) * w)
          << "a = " << a << ", s = " << static_cast<double>(stretch);
    }
  }
}

TEST(Fung, ForceIsTheDerivativeOfTheEnergy) {
  // w = c |xi| W(s), f = dw/d|y| = c dW/ds; in terms of t, dW/ds = g (1 + s).
  const Fung law{10};
  for (long double s : {-0.5L, -0.1L, -1e-3L, 1e-3L, 0.1L, 0.25L, 0.5L}) {
    const double h = 1e-6;
    const double slope =
        (test::energy_factor(law, t_of<double>(s + h)) - test::energy_factor(law, t_of<double>(s - h))) /
        (2 * h);
    const double force = test::force_factor(law, t_of<double>(s)) * (1 + static_cast<double>(s));
    EXPECT_NEAR(slope, force, 1e-8 * (1 + std::abs(force)));
  }
}

TEST(Fung, RatiosToALinearBond) {
  const Fung law{8};
  const double s = 0.25, q = 0.5, h = 1e-5;
  EXPECT_NEAR(law.energy_ratio(s) * s * s / 2, test::energy_factor(law, t_of<double>(s)), 1e-15);
  const auto force = [&](double x) { return test::force_factor(law, t_of<double>(x)) * (1 + x); };
  EXPECT_NEAR(law.stiffness_ratio(s), (force(s + h) - force(s - h)) / (2 * h), 1e-7);
  EXPECT_NEAR(law.stiffness_ratio(s), 2 * std::exp(q), 1e-14);
  EXPECT_NEAR(law.energy_ratio(1e-6), 1, 1e-11);
}

TEST(Fung, CoincidentParticlesHaveAFiniteForce) {
  EXPECT_TRUE(std::isfinite(test::force_factor(Fung{50}, -1.0f)));
  EXPECT_TRUE(std::isfinite(test::force_factor(Fung{50}, -1.0)));
}

}  // namespace
}  // namespace rhexis::peridynamics
