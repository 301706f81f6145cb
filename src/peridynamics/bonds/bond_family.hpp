// SPDX-License-Identifier: BSD-3-Clause
/// Bond families of an extruded body: one short list per column, the same for all of its rows.
///
/// A bond of column i goes to (other column, axial offset): the particle in row k is bonded to row k + offset
/// of the other column. Which of these bonds exist at a row is a question of the body's ends only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "peridynamics/bonds/wall_size.hpp"
#include "peridynamics/geometry/cross_section.hpp"

namespace rhexis::peridynamics {

struct Bond {
  std::int32_t other;  ///< column
  std::int32_t row_offset;
  double xi[3];       ///< reference vector to the other particle, in spacings
  double length;      ///< |xi|, in spacings
  double weight = 1;  ///< factor on force and energy, see surface_correction.hpp
};

/// A forward bond of column `own` leads to a later column, or up in its own column.
inline bool is_forward(const Bond& bond, std::int32_t own) {
  return bond.other > own || (bond.other == own && bond.row_offset > 0);
}

/// Bonds of all columns, those of column c at [first[c], first[c + 1]), in an order that no partition
/// changes, so that sums do not depend on the partition: first backward bonds, by (other, row_offset); then
/// forward bonds, by (row_offset, other), with row_offset falling. Contributions arrive in this order where
/// columns are done one after another, each from its first row on, and forward bonds add to the sums of their
/// other ends (engine/bond_forces.hpp); so ordered, no column is added to twice in a row.
struct BondFamilies {
  std::vector<std::int64_t> first;
  std::vector<Bond> bonds;
  int reach = 0;  ///< largest |row_offset|

  /// Memory that families of this size take, with the lattice and the bins that they are found in.
  static double bytes(const WallSize& size) {
    constexpr double lattice_bytes = 40;  // of a column
    return size.bonds * sizeof(Bond) + size.columns * (sizeof(std::int64_t) + lattice_bytes);
  }

  std::int64_t count(std::size_t column) const { return first[column + 1] - first[column]; }
  std::span<const Bond> of(std::size_t column) const {
    return {bonds.data() + first[column], static_cast<std::size_t>(count(column))};
  }
  std::span<Bond> of(std::size_t column) {
    return {bonds.data() + first[column], static_cast<std::size_t>(count(column))};
  }
};

/// Families that several bodies and checks of one wall share, because they take most of a fine wall's memory.
using SharedFamilies = std::shared_ptr<const BondFamilies>;

/// Eq. (1)'s families, |xi| <= horizon, all weights 1.
BondFamilies find_families(const Lattice& lattice);

/// Undirected bonds in the whole body, ends taken into account.
std::int64_t count_bonds(const Lattice& lattice, const BondFamilies& families, bool periodic);

/// Largest number of bonds that one particle has, ends taken into account.
std::int64_t largest_family(const Lattice& lattice, const BondFamilies& families, bool periodic);

/// A cut along a tube's wall between columns that follow each other; the mean of all such cuts.
struct ColumnCut {
  double columns;  ///< columns on one side that have bonds across the cut
  double bonds;    ///< bonds of one row across the cut
};
ColumnCut mean_column_cut(const BondFamilies& families);

}  // namespace rhexis::peridynamics
