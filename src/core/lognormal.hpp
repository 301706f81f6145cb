// SPDX-License-Identifier: BSD-3-Clause
/// A factor around one that is never negative: what material strength and wall thickness scatter by.
#pragma once

#include <cmath>
#include <numbers>

namespace rhexis {

/// z of the standard normal distribution's lower tail `p` in (0, 1/2]: z <= 0. Abramowitz & Stegun 26.2.23,
/// made exact by Halley's steps.
template <class Real>
Real lower_normal_quantile(Real p) {
  const Real t = std::sqrt(-2 * std::log(p));
  Real z = (Real(2.515517L) + t * (Real(0.802853L) + t * Real(0.010328L))) /
               (1 + t * (Real(1.432788L) + t * (Real(0.189269L) + t * Real(0.001308L)))) -
           t;
  for (int i = 0; i < 3; ++i) {
    const Real below = std::erfc(-z / std::numbers::sqrt2_v<Real>) / 2;
    const Real error = (below - p) * std::sqrt(2 * std::numbers::pi_v<Real>) * std::exp(z * z / 2);
    z -= error / (1 + z * error / 2);
  }
  return z;
}

/// The lognormal distribution of mean 1.
class Lognormal {
 public:
  /// `spread`: coefficient of variation.
  explicit Lognormal(double spread)
      : variance_(std::log1p(static_cast<long double>(spread) * spread)), sigma_(std::sqrt(variance_)) {}

  /// The value below which a share `p` in (0, 1/2] lies.
  template <class Real>
  Real lower(Real p) const {
    return std::exp(Real(sigma_) * lower_normal_quantile(p) - Real(variance_) / 2);
  }
  /// The value above which as much lies as below `lower`: their product is exp(-variance of the logarithm).
  template <class Real>
  Real upper_of(Real lower) const {
    return Real(std::exp(-variance_)) / lower;
  }
  /// A draw: `share` even in (0, 1), `upper` a coin.
  double operator()(double share, bool upper) const {
    const double value = lower(share / 2);
    return upper ? upper_of(value) : value;
  }
  /// The value that stands where `z` stands in the standard normal distribution.
  double of_normal(double z) const {
    return std::exp(static_cast<double>(sigma_) * z - static_cast<double>(variance_) / 2);
  }

 private:
  long double variance_, sigma_;  ///< moments of the logarithm
};

}  // namespace rhexis
