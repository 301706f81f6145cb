// SPDX-License-Identifier: BSD-3-Clause
// Tables of smooth functions, to the last digits.
#include "network/interval_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

namespace rhexis::network {
namespace {

TEST(IntervalTable, AgreesWithTheFunctionOverManyOctaves) {
  const auto function = [](long double x) { return std::pow(x, -1.45L) * (2 + std::sin(std::log(x))); };
  const IntervalTable table(function, 1e-12, 1.0);
  EXPECT_LE(table.largest_error(), 4e-15);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(std::log(1e-12), 0);
  for (int i = 0; i < 20000; ++i) {
    const double x = std::exp(exponent(random));
    EXPECT_NEAR(table(x) / static_cast<double>(function(x)), 1, 1e-14) << x;
  }
}

TEST(IntervalTable, IsExactAroundKinks) {
  const auto function = [](long double x) { return std::max(x, 0.3L) + 1; };
  const IntervalTable smooth(function, 0.1, 1.0), table(function, 0.1, 1.0, {0.3});
  EXPECT_GT(std::abs(smooth(0.3) - 1.3), 1e-9);  // a polynomial cannot
  for (double x = 0.29; x < 0.31; x += 1e-5) EXPECT_NEAR(table(x), static_cast<double>(function(x)), 1e-15);
}

TEST(IntervalTable, ACopyOutlivesTheOriginal) {
  auto original = std::make_unique<IntervalTable>([](long double x) { return x * x; }, 0.1, 1.0);
  const IntervalTable copy = *original;
  EXPECT_NE(copy.rows(), original->rows());
  original.reset();
  EXPECT_DOUBLE_EQ(copy(0.7), 0.7 * 0.7);
}

}  // namespace
}  // namespace rhexis::network
