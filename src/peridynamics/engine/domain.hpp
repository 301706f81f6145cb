// SPDX-License-Identifier: BSD-3-Clause
/// A rank's piece of the vessel: which columns and rows it owns, which it only reads, and how they lie in
/// memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/halo.hpp"
#include "parallel/partition.hpp"
#include "peridynamics/bonds/bond_family.hpp"
#include "peridynamics/engine/body_size.hpp"
#include "peridynamics/engine/column_layout.hpp"
#include "peridynamics/loads/lumen_surface.hpp"

namespace rhexis::peridynamics {

using parallel::block_rows;

/// One block of 16 rows of one owned column.
struct RowBlock {
  std::int32_t slot, block;
};

/// Slots number the columns of this rank: owned columns first, then those of the halo.
///
/// Two kinds of arrays are indexed here. Arrays of owned particles hold column after column, each from its
/// first owned row on. Padded arrays (what bonds read) hold one slot of `stride` values per column; the first
/// owned row stands at `front` in its slot, with halo rows before and after it.
class Domain {
 public:
  Domain(const Lattice& lattice, const BondFamilies& families, const parallel::Partition& partition, int rank,
         bool periodic, const LumenSurface& lumen = {});

  /// Memory of the ranks' domains, and of the cross-section and the layer that each rank holds.
  static double bytes(const BodySize& size) { return 100 * size.columns * size.ranks; }

  const ColumnLayout& layout() const { return layout_; }
  bool periodic() const { return periodic_; }
  /// Blocks of 16 rows of each owned column.
  std::int64_t blocks() const { return (layout_.row_count + block_rows - 1) / block_rows; }
  std::size_t stride() const { return stride_; }
  std::size_t padded_size() const { return stride_ * slot_column_.size(); }

  /// Global numbers of the owned and halo columns, by slot.
  std::span<const std::int32_t> columns() const { return slot_column_; }
  /// Global number of an owned column.
  std::size_t global_column(std::int32_t slot) const {
    return static_cast<std::size_t>(layout_.first_column + slot);
  }
  /// Slot of a global column that is owned or in the halo.
  std::size_t slot(std::int32_t column) const { return static_cast<std::size_t>(slot_of_[column]); }

  /// Index in padded arrays of the first owned row of `slot`.
  std::size_t padded(std::size_t slot) const { return slot * stride_ + front_; }
  /// Index in padded arrays of the first row of a block.
  std::size_t padded(RowBlock b) const {
    return padded(static_cast<std::size_t>(b.slot)) + static_cast<std::size_t>(b.block * block_rows);
  }
  /// Index of a block's first row in arrays of owned particles.
  std::size_t first_particle(RowBlock b) const {
    return static_cast<std::size_t>(b.slot * layout_.row_count + b.block * block_rows);
  }
  /// Number of a block among all owned ones, column after column.
  std::size_t number(RowBlock b) const {
    return static_cast<std::size_t>(std::int64_t{b.slot} * blocks() + b.block);
  }
  /// Owned rows of local block `b`: 16, or fewer in the last one.
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
  std::vector<std::vector<std::int32_t>>
      beside_;  ///< columns that the load on a column depends on; none: dead
  parallel::Partition partition_;
  int rank_;
  bool periodic_;
  int reach_;
  ColumnLayout layout_;
  std::size_t front_ = 0, stride_ = 0;
  std::vector<std::int32_t> slot_column_;   ///< slot -> global column
  std::vector<std::int32_t> slot_of_;       ///< global column -> slot, -1 where not here
  std::vector<char> all_neighbours_owned_;  ///< per owned column
};

}  // namespace rhexis::peridynamics
