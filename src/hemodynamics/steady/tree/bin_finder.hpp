// SPDX-License-Identifier: BSD-3-Clause
/// Finding the bins of a histogram for several values at once.
#pragma once

#include <cstdint>

#include "hemodynamics/steady/tree/bins.hpp"
#include "hemodynamics/steady/tree/lanes.hpp"

namespace rhexis::hemodynamics {

/// The bin of each lane's value.
class BinFinder {
 public:
  using Integers = lanes::hn::RebindToSigned<lanes::Reals>;

  explicit BinFinder(const Bins& bins);

  HWY_INLINE lanes::hn::VFromD<Integers> operator()(lanes::Real v) const {
    namespace hn = lanes::hn;
    const lanes::Reals d;
    const Integers di;
    const auto bin = geometric_
                         ? hn::Sub(hn::Set(di, top_), hn::ShiftRight<shift>(hn::BitCast(di, v)))
                         : hn::ConvertTo(di, hn::Mul(hn::Sub(v, hn::Set(d, low_)), hn::Set(d, per_bin_)));
    return hn::Min(hn::Max(bin, hn::Zero(di)), hn::Set(di, last_));
  }

  static constexpr int shift = 50;  ///< leaves two bits of the mantissa: four bins to an octave

 private:
  bool geometric_;
  std::int64_t last_, top_;
  double low_, per_bin_;
};

}  // namespace rhexis::hemodynamics
