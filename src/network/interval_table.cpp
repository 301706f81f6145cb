// SPDX-License-Identifier: BSD-3-Clause
#include "network/interval_table.hpp"

#include <array>
#include <limits>
#include <numbers>

namespace rhexis::network {
namespace {

constexpr int mantissa_bits = 52;
constexpr int least_bits = 3, most_bits = 10;
constexpr double error_wanted = 4e-15;
constexpr int nodes = IntervalTable::coefficients;
using Values = std::array<long double, nodes>;

/// Coefficients of the polynomial through `values` at the Chebyshev nodes of [-1, 1], lowest power first.
Values polynomial_through(const Values& values) {
  Values power{};
  // Chebyshev coefficients, then T_n in powers: T_{n+1} = 2 u T_n - T_{n-1}.
  Values before{1}, now{0, 1};
  for (int n = 0; n < nodes; ++n) {
    long double sum = 0;
    for (int i = 0; i < nodes; ++i) {
      const long double angle = std::numbers::pi_v<long double> * (2 * i + 1) / (2 * nodes);
      sum += values[static_cast<std::size_t>(i)] * std::cos(n * angle);
    }
    const long double c = sum * (n == 0 ? 1.0L : 2.0L) / nodes;
    const Values& t = n == 0 ? before : now;
    for (std::size_t i = 0; i < nodes; ++i) power[i] += c * t[i];
    if (n == 0) continue;
    Values next{};
    for (std::size_t i = 0; i < nodes; ++i) next[i] = (i > 0 ? 2 * now[i - 1] : 0) - before[i];
    before = now;
    now = next;
  }
  return power;
}

}  // namespace

IntervalTable::IntervalTable(Function function, double low, double high, const std::vector<double>& kinks)
    : function_(std::move(function)) {
  for (int bits = least_bits; bits <= most_bits; ++bits) {
    if (fill(low, high, bits, kinks)) return;
  }
}

/// Makes the table with this many intervals; whether it is accurate (or the finest there may be).
bool IntervalTable::fill(double low, double high, int bits, const std::vector<double>& kinks) {
  shift_ = mantissa_bits - bits;
  scale_ = std::ldexp(1.0, bits + 1);
  first_row_ = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(low) >> shift_);
  const std::int64_t last_row = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(high) >> shift_);
  const auto count = static_cast<std::size_t>(last_row - first_row_ + 1);
  rows_.assign(count, {});
  largest_error_ = 0;
  for (std::int64_t row = 0; row < static_cast<std::int64_t>(count); ++row) {
    const auto edge = [&](std::int64_t r) {
      return std::bit_cast<double>(static_cast<std::uint64_t>(r + first_row_) << shift_);
    };
    const double left = edge(row), right = edge(row + 1);
    Row& c = rows_[static_cast<std::size_t>(row)];
    bool kink = false;
    for (const double k : kinks) kink = kink || (k >= left && k <= right);
    if (kink) {
      c.fill(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const auto argument = [&](long double u) {
      return left + (static_cast<long double>(right) - left) * (u + 1) / 2;
    };
    Values values;
    for (int i = 0; i < nodes; ++i) {
      const long double u = std::cos(std::numbers::pi_v<long double> * (2 * i + 1) / (2 * nodes));
      values[static_cast<std::size_t>(i)] = function_(argument(u));
    }
    const Values power = polynomial_through(values);
    for (std::size_t i = 0; i < nodes; ++i) c[i] = static_cast<double>(power[i]);
    // Between the nodes the error is largest: tried there in long double, so that round-off does not hide it.
    for (int i = 0; i <= nodes; ++i) {
      const long double u = std::cos(std::numbers::pi_v<long double> * i / nodes);
      long double value = power[nodes - 1];
      for (int k = nodes - 2; k >= 0; --k) value = value * u + power[static_cast<std::size_t>(k)];
      const long double truth = function_(argument(u));
      largest_error_ = std::max(largest_error_, static_cast<double>(std::abs(value / truth - 1)));
    }
    if (largest_error_ > error_wanted && bits < most_bits) return false;
  }
  return true;
}

}  // namespace rhexis::network
