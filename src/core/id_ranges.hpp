// SPDX-License-Identifier: BSD-3-Clause
/// Which items of a whole set - points, lines, rows of a table - are on this rank, by their global numbers.
#pragma once

#include <cstdint>
#include <vector>

namespace rhexis {

/// The numbers [first, first + count).
struct IdRange {
  std::int64_t first = 0, count = 0;
  bool operator==(const IdRange&) const = default;
};

/// A rank's part of the numbers 0 to global_count - 1: ranges that ascend and do not touch, of which none is
/// empty. The rank's arrays hold their items in this order. No number is on two ranks.
struct IdRanges {
  std::int64_t global_count = 0;
  std::vector<IdRange> ranges = {};

  std::int64_t local_count() const {
    std::int64_t count = 0;
    for (const IdRange& range : ranges) count += range.count;
    return count;
  }

  /// Adds a range behind the others, perhaps an empty one; it may touch the last.
  void add(IdRange range) {
    if (range.count == 0) return;
    if (!ranges.empty() && ranges.back().first + ranges.back().count == range.first)
      ranges.back().count += range.count;
    else
      ranges.push_back(range);
  }
};

/// A rank's part of a table with a row of `width` values for each number: of the rows `rows` the columns
/// [first, first + count), row after row. Parts of ranks do not overlap.
struct TablePart {
  IdRanges rows;
  std::int64_t width = 1, first = 0, count = 1;

  std::int64_t local_count() const { return rows.local_count() * count; }
};

}  // namespace rhexis
