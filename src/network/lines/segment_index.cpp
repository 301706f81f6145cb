// SPDX-License-Identifier: BSD-3-Clause
#include "network/lines/segment_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace rhexis::network {

SegmentIndex::SegmentIndex(std::size_t segments) : heads_(std::bit_ceil(2 * segments + 1), none) {
  entries_.reserve(2 * segments);
}

Point SegmentIndex::cell_of(int level, const Point& point) {
  const double per_width = std::ldexp(1.0, -level);
  // A zero is added, lest -0 and 0 be two cells.
  return {std::floor(point[0] * per_width) + 0.0, std::floor(point[1] * per_width) + 0.0,
          std::floor(point[2] * per_width) + 0.0};
}

std::size_t SegmentIndex::bucket(int level, const Point& cell) const {
  // The mixing of SplitMix64 (Steele et al. 2014), of one number after the other.
  auto mixed = static_cast<std::uint64_t>(level);
  for (const double number : cell) {
    mixed += std::bit_cast<std::uint64_t>(number) + 0x9e3779b97f4a7c15;
    mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9;
    mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111eb;
    mixed ^= mixed >> 31;
  }
  return mixed & (heads_.size() - 1);
}

void SegmentIndex::add(std::uint32_t segment, const Point& a, const Point& b, double margin) {
  Point low, high;
  double side = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = std::min(a[k], b[k]) - margin;
    high[k] = std::max(a[k], b[k]) + margin;
    side = std::max(side, high[k] - low[k]);
  }
  int level = 0;
  std::frexp(side, &level);  // the smallest power of two that is larger
  if (std::ranges::find(levels_, level) == levels_.end()) levels_.push_back(level);
  // No side is longer than a cell: along each axis the box lies in one cell or in two neighbours.
  const Point first = cell_of(level, low), last = cell_of(level, high);
  for (int corner = 0; corner < 8; ++corner) {
    Point cell = first;
    bool repeated = false;
    for (std::size_t k = 0; k < 3; ++k) {
      if ((corner >> k & 1) == 0) continue;
      repeated = repeated || first[k] == last[k];
      cell[k] = last[k];
    }
    if (repeated) continue;
    std::uint32_t& head = heads_[bucket(level, cell)];
    entries_.push_back({segment, head});
    head = static_cast<std::uint32_t>(entries_.size() - 1);
  }
}

}  // namespace rhexis::network
