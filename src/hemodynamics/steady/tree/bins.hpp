// SPDX-License-Identifier: BSD-3-Clause
/// Bins of histograms.
#pragma once

#include <cstddef>

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

}  // namespace rhexis::hemodynamics
