// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/geometry/gaussian_field.hpp"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhexis::peridynamics {
namespace {

constexpr int degree = 5;
constexpr int taps = degree + 1;

/// The cells along one axis that reach a point: `taps` of them, and the spline's values there, scaled so that
/// their squares sum to 1.
struct Taps {
  std::int64_t first;
  std::array<double, taps> weight{};
};

Taps taps_at(double place) {
  const double cell = std::floor(place), f = place - cell;
  Taps t{static_cast<std::int64_t>(cell)};
  t.weight[0] = 1;
  for (int n = 1; n <= degree; ++n) {  // de Boor's recursion on evenly spaced knots
    for (int j = n; j >= 0; --j) {
      const double before = j > 0 ? t.weight[j - 1] : 0.0;
      t.weight[j] = ((f + n - j) * before + (1 - f + j) * t.weight[j]) / n;
    }
  }
  double squares = 0;
  for (double w : t.weight) squares += w * w;
  for (double& w : t.weight) w /= std::sqrt(squares);
  return t;
}

/// Even in (0, 1), to 53 bits.
double even(std::uint32_t high, std::uint32_t low) {
  return (static_cast<double>((std::uint64_t{high} << 32 | low) >> 12) + 0.5) * 0x1p-52;
}

}  // namespace

GaussianField::GaussianField(std::int64_t seed, double correlation_length)
    : seed_(static_cast<std::uint64_t>(seed)), cells_per_m_(std::numbers::sqrt2 / correlation_length) {}

/// Two independent normal numbers of a cell, by the method of Box and Muller.
GaussianField::Pair GaussianField::noise(std::int64_t i, std::int64_t j, std::int64_t k) const {
  constexpr std::uint32_t stream = 1;  // networks draw from 0
  const r123::Philox4x32::ctr_type bits = r123::Philox4x32()(
      {{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), static_cast<std::uint32_t>(k), stream}},
      {{static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)}});
  const double radius = std::sqrt(-2 * std::log(even(bits[0], bits[1])));
  const double angle = 2 * std::numbers::pi * even(bits[2], bits[3]);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

std::vector<GaussianField::Pair> GaussianField::along(double x, double y, std::span<const double> z) const {
  std::vector<Pair> values(z.size());
  if (z.empty()) return values;
  const Taps in_x = taps_at(x * cells_per_m_), in_y = taps_at(y * cells_per_m_);
  // All of these points share the noise weighted over x and y, one number per layer of cells.
  const auto [lowest, highest] = std::ranges::minmax(z);
  const std::int64_t first = taps_at(lowest * cells_per_m_).first;
  std::vector<Pair> layers(static_cast<std::size_t>(taps_at(highest * cells_per_m_).first - first + taps));
  for (std::size_t k = 0; k < layers.size(); ++k) {
    for (int i = 0; i < taps; ++i) {
      for (int j = 0; j < taps; ++j) {
        const double weight = in_x.weight[i] * in_y.weight[j];
        const Pair n = noise(in_x.first + i, in_y.first + j, first + static_cast<std::int64_t>(k));
        layers[k][0] += weight * n[0];
        layers[k][1] += weight * n[1];
      }
    }
  }
  for (std::size_t p = 0; p < z.size(); ++p) {
    const Taps in_z = taps_at(z[p] * cells_per_m_);
    for (int k = 0; k < taps; ++k) {
      const Pair& layer = layers[static_cast<std::size_t>(in_z.first - first + k)];
      values[p][0] += in_z.weight[k] * layer[0];
      values[p][1] += in_z.weight[k] * layer[1];
    }
  }
  return values;
}

}  // namespace rhexis::peridynamics
