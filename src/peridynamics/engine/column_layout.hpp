// SPDX-License-Identifier: BSD-3-Clause
/// The topology of an extruded tube: particles in columns along the axis, one per row.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/id_ranges.hpp"

namespace rhexis::peridynamics {

/// Particles are numbered id = column * rows + row. This rank has those of the columns [first_column,
/// first_column + column_count) x rows [first_row, first_row + row_count), column after column.
struct ColumnLayout {
  std::int64_t columns = 0, rows = 0;  ///< extent of the whole body
  std::int64_t first_column = 0, column_count = 0;
  std::int64_t first_row = 0, row_count = 0;

  std::int64_t local_count() const { return column_count * row_count; }
  /// Index in this rank's arrays; column and row count from this rank's first.
  std::size_t particle(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(column * row_count + row);
  }

  IdRanges ids() const {
    IdRanges ids{.global_count = columns * rows};
    for (std::int64_t c = 0; c < column_count; ++c)
      ids.add({(first_column + c) * rows + first_row, row_count});
    return ids;
  }
};

}  // namespace rhexis::peridynamics
