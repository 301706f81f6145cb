// SPDX-License-Identifier: BSD-3-Clause
/// A factor around one that is never negative, with the tail of the weakest link: how strength scatters where
/// the worst of many flaws decides (Weibull 1951).
#pragma once

#include <cmath>
#include <numbers>

namespace rhexis {

/// The Weibull distribution of mean 1: P(X <= x) = 1 - exp(-(x / scale)^shape).
class Weibull {
 public:
  /// `spread`: coefficient of variation, in (0, 1].
  explicit Weibull(double spread) : shape_(shape_of(spread)), scale_(1 / std::tgamma(1 + 1 / shape_)) {}

  double shape() const { return shape_; }

  /// The value that stands where `z` stands in the standard normal distribution.
  double of_normal(double z) const {
    // -log P(Z > z), by the smaller of the two tails.
    const double tail = 0.5 * std::erfc(std::abs(z) / std::numbers::sqrt2);
    const double hazard = z > 0 ? -std::log(tail) : -std::log1p(-tail);
    return scale_ * std::pow(hazard, 1 / shape_);
  }

 private:
  /// Solves  1 + spread^2 = gamma(1 + 2/k) / gamma(1 + 1/k)^2,  whose right side falls as k grows.
  static double shape_of(double spread) {
    const double wanted = std::log1p(spread * spread);
    // The spread lies between 1 / k and pi / (sqrt(6) k) for k >= 1.
    double low = 0.5 / spread, high = 2 / spread;
    for (int i = 0; i < 60; ++i) {
      const double k = 0.5 * (low + high);
      (std::lgamma(1 + 2 / k) - 2 * std::lgamma(1 + 1 / k) > wanted ? low : high) = k;
    }
    return 0.5 * (low + high);
  }

  double shape_, scale_;
};

}  // namespace rhexis
