// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/probability.hpp"

#include <gtest/gtest.h>

namespace rhexis::ensemble {
namespace {

// Brown, Cai & DasGupta 2001 and R's binom.confint(method = "wilson").
TEST(WilsonInterval, IsThePublishedOne) {
  EXPECT_NEAR(wilson_interval(0, 10).low, 0, 0);
  EXPECT_NEAR(wilson_interval(0, 10).high, 0.2775328, 1e-7);
  EXPECT_NEAR(wilson_interval(10, 10).low, 1 - 0.2775328, 1e-7);
  EXPECT_NEAR(wilson_interval(10, 10).high, 1, 0);
  EXPECT_NEAR(wilson_interval(5, 10).low, 0.2365931, 1e-7);
  EXPECT_NEAR(wilson_interval(5, 10).high, 0.7634069, 1e-7);
}

// Its ends are the probabilities that lie z standard deviations of their own from what was counted.
TEST(WilsonInterval, SolvesItsEquation) {
  for (const auto& [k, n] : {std::pair{3, 100}, {50, 100}, {999, 1000}}) {
    const auto [low, high] = wilson_interval(k, n);
    const double p = static_cast<double>(k) / n;
    for (const double end : {low, high})
      EXPECT_NEAR((p - end) * (p - end) * n / (end * (1 - end)), 1.959963984540054 * 1.959963984540054, 1e-9);
    EXPECT_LT(low, p);
    EXPECT_GT(high, p);
  }
  EXPECT_EQ(wilson_interval(0, 0).low, 0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1);
}

TEST(Probability, CountsByPressure) {
  const std::vector<Sample> samples{{.pressure = 1e4, .wall = 0},
                                    {.pressure = 2e4, .wall = 0, .ruptured = true, .onset = 1e-3},
                                    {.pressure = 1e4, .wall = 1},
                                    {.pressure = 2e4, .wall = 1, .ruptured = true, .onset = 3e-3},
                                    {.pressure = 2e4, .wall = 2}};
  const auto rows = probabilities(samples);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].pressure, 1e4);
  EXPECT_EQ(rows[0].value(), 0);
  EXPECT_FALSE(rows[0].mean_onset);
  EXPECT_EQ(rows[1].samples, 3);
  EXPECT_EQ(rows[1].ruptured, 2);
  EXPECT_DOUBLE_EQ(*rows[1].mean_onset, 2e-3);
  const std::string table = probability_table({rows[0]});
  EXPECT_EQ(table.substr(table.find('\n') + 1, 14), "10000,2,0,0,0,");
  EXPECT_EQ(table.substr(table.size() - 2), ",\n");
}

}  // namespace
}  // namespace rhexis::ensemble
