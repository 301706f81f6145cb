// SPDX-License-Identifier: BSD-3-Clause
#include "core/lognormal.hpp"

#include <gtest/gtest.h>

#include <vector>

using rhexis::Lognormal;
using rhexis::lower_normal_quantile;

TEST(NormalQuantile, InvertsTheDistributionFarIntoItsTail) {
  for (const double p : {0.5, 0.499999, 0.3, 0.1, 1e-3, 1e-6, 1e-9, 0x1p-33}) {
    const double z = lower_normal_quantile(p);
    EXPECT_LE(z, 1e-9);
    EXPECT_NEAR(std::erfc(-z / std::sqrt(2.0)) / 2 / p, 1, 1e-13) << p;
  }
  EXPECT_NEAR(lower_normal_quantile(0.025), -1.959963984540054, 1e-14);
}

// Over even shares of the distribution: the moments are sums of its quantiles.
TEST(Lognormal, HasMeanOneAndTheGivenSpread) {
  for (const double spread : {0.05, 0.3}) {
    const Lognormal factor(spread);
    constexpr int n = 200000;
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
      for (const bool upper : {false, true}) {
        const double f = factor((i + 0.5) / n, upper);
        EXPECT_GT(f, 0);
        sum += f;
        squares += f * f;
      }
    }
    const double mean = sum / (2 * n);
    EXPECT_NEAR(mean, 1, 1e-6);
    EXPECT_NEAR(std::sqrt(squares / (2 * n) - mean * mean), spread, 1e-4 * spread);
  }
}

TEST(Lognormal, OfANormalValueIsTheSameQuantile) {
  const Lognormal factor(0.3);
  const double share = 0.1;  // of the lower half
  const double z = lower_normal_quantile(share / 2);
  EXPECT_NEAR(factor.of_normal(z), factor(share, false), 1e-14);
  EXPECT_NEAR(factor.of_normal(-z), factor(share, true), 1e-14);
}

TEST(Lognormal, SplitsAtItsMedian) {
  const Lognormal factor(0.2);
  EXPECT_NEAR(factor(1 - 1e-12, false), factor(1 - 1e-12, true), 1e-9);
  EXPECT_LT(factor(0.5, false), factor(0.9, false));
  EXPECT_GT(factor(0.5, true), factor(0.9, true));
}
