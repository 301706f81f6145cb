// SPDX-License-Identifier: BSD-3-Clause
/// A smooth positive function of a positive number, tabulated so that its values cost a few nanoseconds to
/// the last digits: every octave is cut into 2^bits even intervals, each with the polynomial of degree 7
/// through the function's values at 8 Chebyshev nodes. The interval and the place in it are read off the bits
/// of the floating-point number.
///
/// `bits` is the least number for which the relative error is below 4e-15 everywhere that was tried (at 9
/// points of every interval, against long double). Intervals around kinks of the function are left out;
/// there, the function itself is called.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace rhexis::network {

class IntervalTable {
 public:
  static constexpr int coefficients = 8;
  using Function = std::function<long double(long double)>;

  IntervalTable() = default;
  /// For arguments in [low, high]; `kinks`: where the function is not smooth.
  IntervalTable(Function function, double low, double high, const std::vector<double>& kinks = {});

  double operator()(double argument) const {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(argument);
    const Row& c = rows_[static_cast<std::size_t>(row_of(bits))];
    const double u = place(bits);
    double value = c.back();
    for (std::size_t i = coefficients - 1; i-- > 0;) value = std::fma(value, u, c[i]);
    return std::isnan(value) ? exact(argument) : value;
  }

  double exact(double argument) const { return static_cast<double>(function_(argument)); }

  /// For the vector code: row r = (bits of the argument >> shift) - first_row holds 8 coefficients, lowest
  /// first; in the interval, u = 2 (place within it) - 1. Rows around kinks hold nan.
  const double* rows() const { return rows_.front().data(); }
  int shift() const { return shift_; }
  std::int64_t first_row() const { return first_row_; }
  double largest_error() const { return largest_error_; }

 private:
  std::int64_t row_of(std::uint64_t bits) const {
    return static_cast<std::int64_t>(bits >> shift_) - first_row_;
  }
  double place(std::uint64_t bits) const {
    const std::uint64_t low_bits = bits & ((std::uint64_t{1} << shift_) - 1);
    const double one_and_more = std::bit_cast<double>(low_bits | 0x3ff0000000000000u);
    return std::fma(one_and_more, scale_, -scale_ - 1);
  }
  bool fill(double low, double high, int bits, const std::vector<double>& kinks);

  Function function_;
  struct alignas(64) Row : std::array<double, coefficients> {};
  std::vector<Row> rows_;  ///< a cache line each
  int shift_ = 0;
  std::int64_t first_row_ = 0;
  double scale_ = 0;  ///< 2^(bits + 1)
  double largest_error_ = 0;
};

}  // namespace rhexis::network
