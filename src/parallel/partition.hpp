// SPDX-License-Identifier: BSD-3-Clause
/// Columns x axial blocks over ranks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace rhexis::parallel {

/// Rows are dealt out in whole blocks of this many: the width of a word of bond bits. What is summed within a
/// block is then summed in the same order whatever the partition.
inline constexpr std::int64_t block_rows = 16;

/// Rank r holds columns [column_start[i], column_start[i+1]) and blocks [block_start[k], block_start[k+1])
/// with i = r % column_parts(), k = r / column_parts().
struct Partition {
  std::vector<std::int64_t> column_start, block_start;
  std::int64_t rows = 0;

  int column_parts() const { return static_cast<int>(column_start.size()) - 1; }
  int block_parts() const { return static_cast<int>(block_start.size()) - 1; }
  int ranks() const { return column_parts() * block_parts(); }
  int column_part_of(std::int64_t column) const;
  int block_part_of_row(std::int64_t row) const;
  int rank_of(std::int64_t column, std::int64_t row) const {
    return block_part_of_row(row) * column_parts() + column_part_of(column);
  }
  /// [first, past) rows of a rank.
  std::int64_t first_row(int rank) const { return block_start[rank / column_parts()] * block_rows; }
  std::int64_t past_row(int rank) const;
  std::int64_t first_column(int rank) const { return column_start[rank % column_parts()]; }
  std::int64_t past_column(int rank) const { return column_start[rank % column_parts() + 1]; }
};

/// What cuts cost each side of them.
struct CutCosts {
  double bonds_across = 0;  ///< a row, by a cut between columns: evaluated by both sides
  double halo_columns = 0;  ///< columns that a cut between columns adds; none where both sides share memory
  double halo_rows = 0;     ///< rows that a cut between blocks of rows adds
};

/// The split of `ranks` into column parts x block parts of a tube with the least work on the busiest rank:
/// the columns' weights (bonds of a column) times blocks, what is evaluated twice because a cut goes through
/// it, and a charge for halo particles. Throws RunError where there are more ranks than pieces.
Partition make_partition(int ranks, std::span<const double> column_weights, std::int64_t rows,
                         const CutCosts& cut);

}  // namespace rhexis::parallel
