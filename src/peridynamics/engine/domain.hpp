/// A rank's piece of the vessel: which columns and rows it owns, which it only reads, and how they lie in
/// memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/field_view.hpp"
#include "parallel/halo.hpp"
#include "parallel/partition.hpp"
#include "peridynamics/bonds/bond_family.hpp"

namespace rhexis::peridynamics {

/// Memory of padded arrays (what bonds read): one slot of `stride` values per column, owned columns first,
/// then halo columns; row `first_row` of a column stands at `front` in its slot, with halo rows before and
/// after it.
class Domain {
 public:
  Domain(const Lattice& lattice, const BondFamilies& families, const parallel::Partition& partition, int rank,
         bool periodic);

  const PointLayout& layout() const { return layout_; }
  std::int64_t blocks() const {
    return (layout_.row_count + parallel::block_rows - 1) / parallel::block_rows;
  }
  std::size_t stride() const { return stride_; }
  std::size_t padded_size() const { return stride_ * slot_column_.size(); }

  /// Offset in a padded array of a local column's first owned row. Local columns: owned first, then halo.
  std::size_t padded(std::size_t slot) const { return slot * stride_ + front_; }
  /// Columns that are owned or in the halo, by slot.
  std::span<const std::int32_t> columns() const { return slot_column_; }
  /// Slot of a global column that is owned or in the halo.
  std::size_t slot(std::int32_t column) const { return static_cast<std::size_t>(slot_of_[column]); }
  /// Rows of block `b` on this rank (16, or fewer in the last).
  int rows_in(std::int64_t block) const;

  /// One bit per row of local block `b`: the row's partner `row_offset` rows away exists.
  std::uint16_t partners(std::int64_t block, int row_offset) const;

  /// True where all that block `b` of owned column `column_slot` reads is owned.
  bool interior(std::size_t column_slot, std::int64_t block) const;

  /// Messages that fill the halo of padded arrays; collective knowledge, no communication.
  std::vector<parallel::HaloMessage> halo_messages() const;

 private:
  struct Needed {
    std::int32_t column;
    std::int64_t first_row, count;  ///< count rows, all of one owner
    std::int64_t halo_row;  ///< row number in the reader's halo; differs from first_row across a period
    int owner;
  };
  std::vector<std::int32_t> halo_columns(int rank) const;
  std::vector<Needed> needed_by(int rank) const;

  const BondFamilies* families_;
  parallel::Partition partition_;
  int rank_;
  bool periodic_;
  int reach_;
  PointLayout layout_;
  std::size_t front_ = 0, stride_ = 0;
  std::vector<std::int32_t> slot_column_;   ///< slot -> global column
  std::vector<std::int32_t> slot_of_;       ///< global column -> slot, -1 where not here
  std::vector<char> all_neighbours_owned_;  ///< per owned column
};

}  // namespace rhexis::peridynamics
