// SPDX-License-Identifier: BSD-3-Clause
#include "core/weibull.hpp"

#include <gtest/gtest.h>

using rhexis::Weibull;

TEST(Weibull, ShapeOneIsTheExponentialDistribution) {
  const Weibull factor(1);
  EXPECT_NEAR(factor.shape(), 1, 1e-12);
  EXPECT_NEAR(factor.of_normal(0), std::log(2), 1e-12);
  // P(Z > 3) = 1.349898e-3: the exponential of mean 1 is above -log of that as rarely.
  EXPECT_NEAR(factor.of_normal(3), -std::log(1.3498980316300946e-3), 1e-11);
  EXPECT_NEAR(factor.of_normal(-3),
              1.3498980316300946e-3 + 0.5 * 1.3498980316300946e-3 * 1.3498980316300946e-3, 1e-9);
}

// By the trapezoidal rule over the normal density, which is exact to round-off for smooth integrands.
TEST(Weibull, HasMeanOneAndTheGivenSpread) {
  for (const double spread : {0.01, 0.1, 0.5, 1.0}) {
    const Weibull factor(spread);
    double mean = 0, square = 0;
    constexpr double step = 1e-3;
    for (double z = -12; z <= 12; z += step) {
      const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
      const double f = factor.of_normal(z);
      mean += step * density * f;
      square += step * density * f * f;
    }
    EXPECT_NEAR(mean, 1, 1e-9) << spread;
    EXPECT_NEAR(std::sqrt(square - mean * mean) / spread, 1, 1e-6) << spread;
  }
}
