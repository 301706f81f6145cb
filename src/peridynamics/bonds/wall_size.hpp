// SPDX-License-Identifier: BSD-3-Clause
/// How much there is of a wall, by formulas: known before anything of it is made.
#pragma once

#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

/// As real numbers, for walls beyond any machine are to be told of too.
struct WallSize {
  double columns = 0, rows = 0;
  double bonds = 0;       ///< bonds in the families of all columns, as BondFamilies holds them
  double neighbours = 0;  ///< columns that a column has bonds with, the mean, itself among them
  double rings = 0;       ///< rings of a polar cross-section, else 0

  double particles() const { return columns * rows; }
  double bonds_of_column() const { return bonds / (columns > 1 ? columns : 1); }
};

/// The size of the wall that resolved parameters describe; counted ring by ring or row by row of the
/// cross-section, so exact (but for lattices of more than 1e5 rows, which no machine holds: an upper bound).
WallSize wall_size(const Parameters& p);

/// Rows that lie within `reach` of a row, itself among them; `reach` in spacings of rows.
double rows_within(double reach);

}  // namespace rhexis::peridynamics
