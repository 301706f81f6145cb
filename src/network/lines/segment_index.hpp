// SPDX-License-Identifier: BSD-3-Clause
/// Finds the segments of centre lines that lie near a point, in a time that does not grow with their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "network/graph.hpp"

namespace rhexis::network {

/// A spatial hash of one grid for each power of two. A segment, with the margin around it that counts as
/// near, stands in the at most 8 cells that it touches of the grid whose cells are as large as it is; a point
/// is in one cell of each grid.
class SegmentIndex {
 public:
  /// Room for `segments` segments, fewer than 2^29.
  explicit SegmentIndex(std::size_t segments);

  /// Enters segment number `segment` from a to b; points within `margin` (not negative) of it will find it.
  void add(std::uint32_t segment, const Point& a, const Point& b, double margin);

  /// Calls `visit(segment)` for every segment whose margin may hold the point, and for some that are farther
  /// away. A segment may come twice.
  template <class Visit>
  void for_each_near(const Point& point, const Visit& visit) const {
    for (const int level : levels_) {
      for (std::uint32_t e = heads_[bucket(level, cell_of(level, point))]; e != none; e = entries_[e].next)
        visit(entries_[e].segment);
    }
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  struct Entry {
    std::uint32_t segment, next;
  };
  /// The cell of grid `level`, whose cells are 2^level wide, that a point is in, by three whole numbers.
  static Point cell_of(int level, const Point& point);
  std::size_t bucket(int level, const Point& cell) const;

  std::vector<std::uint32_t> heads_;  ///< [buckets], the first entry of each; cells may share a bucket
  std::vector<Entry> entries_;
  std::vector<int> levels_;  ///< grids in use
};

}  // namespace rhexis::network
