// SPDX-License-Identifier: BSD-3-Clause
/// Two independent Gaussian random fields in space: at every point of mean 0 and variance 1, smooth over a
/// correlation length, and a function of (seed, position) alone, so that ranks, threads and any resolution
/// see the same ones.
///
/// Space is cut into cubes of side h = l / sqrt(2), each with two independent normal numbers n_c that Philox
/// (Salmon et al. 2011, doi:10.1145/2063384.2063405) draws from the seed and the cube's place. A value is
///
///   g(x) = sum_c w_c(x) n_c,   w_c(x) ~ b(x/h - i_c) b(y/h - j_c) b(z/h - k_c),   sum_c w_c(x)^2 = 1,
///
/// with the quintic B-spline b, six cubes wide. Averaged over where the cubes lie, the correlation at
/// distance r is that of b with itself, within 0.01 of exp(-(r/l)^2) in every direction; and exactly 0 from 6
/// h on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rhexis::peridynamics {

class GaussianField {
 public:
  using Pair = std::array<double, 2>;  ///< a value of each field

  /// `correlation_length` l in m.
  GaussianField(std::int64_t seed, double correlation_length);

  /// Values at (x, y, z[i]), m; the same digits whichever other heights are asked for along with them.
  std::vector<Pair> along(double x, double y, std::span<const double> z) const;

 private:
  Pair noise(std::int64_t i, std::int64_t j, std::int64_t k) const;

  std::uint64_t seed_;
  double cells_per_m_;
};

}  // namespace rhexis::peridynamics
