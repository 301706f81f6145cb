// SPDX-License-Identifier: BSD-3-Clause
/// Operations on long vectors by threads. Sums are formed over blocks of a fixed size and then over blocks,
/// so the digits do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "parallel/threads.hpp"

namespace rhexis::hemodynamics {

inline double dot(std::span<const double> a, std::span<const double> b, int threads) {
  constexpr std::size_t block = 4096;
  std::vector<double> sums((a.size() + block - 1) / block);
  parallel::for_each_share(threads, sums.size(), [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      double sum = 0;
      for (std::size_t i = s * block; i < std::min(a.size(), (s + 1) * block); ++i) sum += a[i] * b[i];
      sums[s] = sum;
    }
  });
  double sum = 0;
  for (const double part : sums) sum += part;
  return sum;
}

/// nan if any is nan.
inline double largest(std::span<const double> a) {
  double result = 0;
  for (const double value : a) result = std::abs(value) <= result ? result : std::abs(value);
  return result;
}

/// y = x + scale * y
inline void scale_and_add(std::span<const double> x, double scale, std::span<double> y, int threads) {
  parallel::for_each_share(threads, x.size(), [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y[i] = x[i] + scale * y[i];
  });
}

/// y += scale * x
inline void add_scaled(double scale, std::span<const double> x, std::span<double> y, int threads) {
  parallel::for_each_share(threads, x.size(), [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y[i] += scale * x[i];
  });
}

}  // namespace rhexis::hemodynamics
