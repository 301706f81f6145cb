// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/tree/bins.hpp"

#include <bit>
#include <cstdint>

#include "hemodynamics/steady/tree/bin_finder.hpp"

namespace rhexis::hemodynamics {
namespace {

std::uint64_t quarter_octave(double value) {
  return std::bit_cast<std::uint64_t>(value) >> BinFinder::shift;
}
double quarter_edge(std::uint64_t quarter) {
  return std::bit_cast<double>(quarter << BinFinder::shift);
}

}  // namespace

double Bins::lower_edge(std::size_t bin) const {
  if (geometric) return quarter_edge(quarter_octave(high) - bin);
  return low + (high - low) * static_cast<double>(bin) / static_cast<double>(count);
}

double Bins::upper_edge(std::size_t bin) const {
  if (geometric) return quarter_edge(quarter_octave(high) - bin + 1);
  return lower_edge(bin + 1);
}

BinFinder::BinFinder(const Bins& bins)
    : geometric_(bins.geometric),
      last_(static_cast<std::int64_t>(bins.count) - 1),
      top_(static_cast<std::int64_t>(quarter_octave(bins.high))),
      low_(bins.low),
      per_bin_(static_cast<double>(bins.count) / (bins.high - bins.low)) {}

}  // namespace rhexis::hemodynamics
