// SPDX-License-Identifier: BSD-3-Clause
// The random field against what it must be in closed form, over many seeds: each gives an independent field.
#include "peridynamics/geometry/gaussian_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhexis::peridynamics {
namespace {

constexpr double length = 2.5e-4;
constexpr int seeds = 20000;
/// Five standard errors of a mean of `seeds` values of variance 1.
const double tolerance = 5 / std::sqrt(seeds);

using Point = std::array<double, 3>;

/// A place for each seed, so that averages are also over where points lie within the cells.
Point place(int seed) {
  const auto fraction = [&](double step) { return std::fmod(seed * step, 1.0); };
  return {1e-3 * fraction(0.6180339887), 1e-3 * fraction(0.7548776662), 1e-3 * fraction(0.5698402910)};
}

GaussianField::Pair value(const GaussianField& field, const Point& x) {
  const double z[] = {x[2]};
  return field.along(x[0], x[1], z).front();
}

TEST(GaussianField, IsStandardNormalEverywhere) {
  // At a corner, an edge and an inner point of a cell, and at places all over.
  const double cell = length / std::numbers::sqrt2;
  for (const double offset : {0.0, 0.3, 0.5, -1.0}) {
    std::vector<double> values;
    double mean = 0, variance = 0, product = 0;
    for (int s = 0; s < seeds; ++s) {
      const Point x = offset < 0 ? place(s) : Point{offset * cell, 3 * cell, (7 + offset) * cell};
      const auto [a, b] = value(GaussianField(s, length), x);
      mean += a / seeds;
      variance += a * a / seeds;
      product += a * b / seeds;
      values.push_back(a);
    }
    EXPECT_NEAR(mean, 0, tolerance) << offset;
    EXPECT_NEAR(variance, 1, std::numbers::sqrt2 * tolerance) << offset;
    EXPECT_NEAR(product, 0, tolerance) << "the two fields are independent";
    // Kolmogorov and Smirnov: exceeded by chance once in 1000 trials.
    std::ranges::sort(values);
    double distance = 0;
    for (int s = 0; s < seeds; ++s) {
      const double p = 0.5 * std::erfc(-values[static_cast<std::size_t>(s)] / std::numbers::sqrt2);
      distance = std::max({distance, p - double(s) / seeds, double(s + 1) / seeds - p});
    }
    EXPECT_LT(distance * std::sqrt(seeds), 1.95) << offset;
  }
}

TEST(GaussianField, CorrelationIsAGaussianOfTheDistanceInEveryDirection) {
  // Along lines of 200 correlation lengths, each about as many independent values of both fields.
  constexpr int lines = 100;
  std::vector<double> z;
  for (int i = 0; i < 800; ++i) z.push_back(0.253 * length * i);
  const double d = 1 / std::sqrt(3.0);
  for (const Point& direction : {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}, Point{d, d, d}}) {
    for (const double distance : {0.5, 1.0, 1.6}) {
      double product = 0, crossed = 0;
      for (int s = 0; s < lines; ++s) {
        const GaussianField field(s, length);
        const Point x = place(s);
        std::vector<double> moved = z;
        for (double& height : moved) height += distance * length * direction[2];
        const auto here = field.along(x[0], x[1], z);
        const auto there = field.along(x[0] + distance * length * direction[0],
                                       x[1] + distance * length * direction[1], moved);
        for (std::size_t i = 0; i < z.size(); ++i) {
          product += here[i][0] * there[i][0] + here[i][1] * there[i][1];
          crossed += here[i][0] * there[i][1];
        }
      }
      const double pairs = lines * static_cast<double>(z.size());
      EXPECT_NEAR(product / (2 * pairs), std::exp(-distance * distance), 0.01 + 0.7 * tolerance) << distance;
      EXPECT_NEAR(crossed / pairs, 0, tolerance) << distance;
    }
  }
}

TEST(GaussianField, IsExactlyUncorrelatedBeyondSixCells) {
  // The cells that reach one point do not reach the other: nothing is left but chance.
  double product = 0;
  for (int s = 0; s < seeds; ++s) {
    const GaussianField field(s, length);
    const Point x = place(s);
    product +=
        value(field, x)[0] * value(field, {x[0], x[1] - 6 * length / std::numbers::sqrt2, x[2]})[0] / seeds;
  }
  EXPECT_NEAR(product, 0, tolerance);
}

TEST(GaussianField, DoesNotDependOnWhatElseIsAsked) {
  const GaussianField field(7, length);
  std::vector<double> z;
  for (int i = 0; i < 50; ++i) z.push_back((i * 37 % 50) * 1e-4 - 1e-3);
  const auto together = field.along(1e-3, -2e-3, z);
  for (std::size_t i = 0; i < z.size(); ++i) EXPECT_EQ(together[i], value(field, {1e-3, -2e-3, z[i]}));
  EXPECT_NE(together, GaussianField(8, length).along(1e-3, -2e-3, z));
}

}  // namespace
}  // namespace rhexis::peridynamics
