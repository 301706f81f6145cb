/// Bond families of an extruded body: one short list per column, the same for all of its rows.
///
/// A bond of column i goes to (other column, axial offset): the particle in row k is bonded to row k + offset
/// of the other column. Which of these bonds exist at a row is a question of the body's ends only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "peridynamics/geometry/cross_section.hpp"

namespace rhexis::peridynamics {

struct Bond {
  std::int32_t other;  ///< column
  std::int32_t row_offset;
  double xi[3];       ///< reference vector to the other particle, in spacings
  double length;      ///< |xi|, in spacings
  double weight = 1;  ///< factor on force and energy, see surface_correction.hpp
};

/// A bond of column `own` leads to a later column, or up in its own.
inline bool leads_later(const Bond& bond, std::int32_t own) {
  return bond.other > own || (bond.other == own && bond.row_offset > 0);
}

/// Bonds of all columns, those of column c at [first[c], first[c + 1]), in an order that no partition
/// changes, so that sums do not depend on one: first those that lead to earlier columns or down, by (other,
/// row_offset); then those that lead later, by (row_offset, other), row_offset falling. It is the order in
/// which contributions arrive where columns, one after another and each from its first row on, add to
/// the sums of those (column_body_parts.hpp), and there no column is added to twice in a row.
struct BondFamilies {
  std::vector<std::int64_t> first;
  std::vector<Bond> bonds;
  int reach = 0;  ///< largest |row_offset|

  std::int64_t count(std::size_t column) const { return first[column + 1] - first[column]; }
  std::span<const Bond> of(std::size_t column) const {
    return {bonds.data() + first[column], static_cast<std::size_t>(count(column))};
  }
  std::span<Bond> of(std::size_t column) {
    return {bonds.data() + first[column], static_cast<std::size_t>(count(column))};
  }
};

/// Families that several bodies and checks of one wall read: they are what a fine wall has most of.
using SharedFamilies = std::shared_ptr<const BondFamilies>;

/// Eq. (1)'s families, |xi| <= horizon, all weights 1.
BondFamilies find_families(const Lattice& lattice);

/// Undirected bonds in the whole body, ends taken into account.
std::int64_t count_bonds(const Lattice& lattice, const BondFamilies& families, bool periodic);

/// Largest number of bonds that one particle has, ends taken into account.
std::int64_t largest_family(const Lattice& lattice, const BondFamilies& families, bool periodic);

/// What a cut along a tube's wall meets, the mean of all cuts between columns that follow each other.
struct ColumnCut {
  double columns;  ///< on one side that have bonds across it
  double bonds;    ///< across it, of a row
};
ColumnCut mean_column_cut(const BondFamilies& families);

}  // namespace rhexis::peridynamics
