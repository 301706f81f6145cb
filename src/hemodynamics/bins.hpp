/// Bins of histograms, and finding them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hemodynamics/lanes.hpp"

namespace rhexis::hemodynamics {

/// Bins of a histogram. Linear: even between `low` and `high`. Geometric: four to an octave downwards from
/// `high`'s octave (edges at 1, 1.25, 1.5, 1.75 times a power of two). What lies outside counts into the
/// outermost bins.
struct Bins {
  bool geometric = false;
  std::size_t count = 0;
  double low = 0, high = 0;
  double lower_edge(std::size_t bin) const;
  double upper_edge(std::size_t bin) const;
};

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
