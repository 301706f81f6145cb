// SPDX-License-Identifier: BSD-3-Clause
/// Sums of doubles that do not depend on the order of their terms, hence not on ranks and threads.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "parallel/communicator.hpp"

namespace rhexis::parallel {

/// Fixed-point accumulator: terms are cut to a quantum 2^-80 times the power of two above `scale` and added
/// as 128-bit integers, which is exact. A scale of 0 counts as 1. Terms up to 2^20 times the scale fit;
/// larger ones (or nan) make it infinite.
class ExactSum {
 public:
  explicit ExactSum(double scale)
      : quantum_(std::ldexp(1.0, std::ilogb(scale > 0 ? scale : 1.0) + 1 - 80)), per_quantum_(1 / quantum_) {}

  void add(double term) {
    const double units = term * per_quantum_;
    if (std::abs(units) < 0x1p100) {
      // In two parts: compilers call a function to make 128 bits of a double.
      const double high = std::trunc(units * 0x1p-63);
      total_ += static_cast<Integer>(static_cast<std::int64_t>(high)) * (Integer{1} << 63) +
                static_cast<std::int64_t>(units - high * 0x1p63);
    } else {
      overflow_ = true;
    }
  }

  void add(const ExactSum& other) {
    total_ += other.total_;
    overflow_ = overflow_ || other.overflow_;
  }

  /// The sum of this rank alone.
  double value() const {
    return overflow_ ? std::numeric_limits<double>::infinity() : static_cast<double>(total_) * quantum_;
  }

  /// Over all ranks (collective).
  double value(Communicator comm) const { return over(comm).value(); }

  /// The same, to be added to another sum of this scale without loss: as a double, and what it rounds away.
  std::array<double, 2> parts(Communicator comm) const {
    const ExactSum sum = over(comm);
    const double rounded = sum.value();
    if (sum.overflow_) return {rounded, 0};
    const Integer rest = sum.total_ - static_cast<Integer>(rounded / quantum_);
    return {rounded, static_cast<double>(rest) * quantum_};
  }

 private:
  __extension__ using Integer = __int128;

  ExactSum over(Communicator comm) const {
    // Four limbs of 32 bits, the last one signed: sums over up to 2^31 ranks fit 64 bits each.
    std::int64_t limbs[5];
    Integer rest = total_;
    for (int i = 0; i < 3; ++i) {
      limbs[i] = static_cast<std::int64_t>(rest & 0xffffffff);
      rest >>= 32;
    }
    limbs[3] = static_cast<std::int64_t>(rest);
    limbs[4] = overflow_;
    comm.all_reduce(limbs, Reduce::sum);
    ExactSum sum(*this);
    sum.overflow_ = limbs[4] != 0;
    sum.total_ = 0;
    for (int i = 3; i >= 0; --i) sum.total_ = sum.total_ * (Integer{1} << 32) + limbs[i];
    return sum;
  }

  double quantum_, per_quantum_;  // powers of two
  Integer total_ = 0;
  bool overflow_ = false;
};

}  // namespace rhexis::parallel
