// SPDX-License-Identifier: BSD-3-Clause
/// How much there is of a body, by which the parts of the engine tell what memory they take (their `bytes`).
#pragma once

#include <cmath>

#include "parallel/partition.hpp"
#include "peridynamics/bonds/wall_size.hpp"
#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

/// On all ranks together; as real numbers, for bodies beyond any machine are to be told of too.
struct BodySize {
  double columns = 0, rows = 0;  ///< owned
  double bonds = 0;              ///< bonds in the families of owned columns
  double halo_columns = 0;
  int ranks = 1;
  double lumen_nodes = 0;  ///< of the surface on which a pressure that follows the wall acts; 0: it is dead
  bool heterogeneous = false;  ///< critical stretch or stiffness differs from place to place
  bool thinned = false;        ///< thin spots leave out particles

  double particles() const { return columns * rows; }
  double blocks_of_column() const { return std::ceil(rows / static_cast<double>(parallel::block_rows)); }
  double blocks() const { return columns * blocks_of_column(); }
  double words() const { return bonds * blocks_of_column(); }
  /// Values of a column in a padded array (see Domain), and of the whole array.
  double stride() const { return static_cast<double>(parallel::block_rows) * (blocks_of_column() + 2); }
  double padded() const { return (columns + halo_columns) * stride(); }
};

/// A body of `rows` rows of a wall, dealt out among `ranks`.
BodySize body_size(const Parameters& p, const WallSize& wall, double rows, int ranks);

}  // namespace rhexis::peridynamics
