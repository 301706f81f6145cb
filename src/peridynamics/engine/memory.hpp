// SPDX-License-Identifier: BSD-3-Clause
/// What a wall takes in memory, by formulas: known before anything of it is made.
#pragma once

#include <cstdint>

#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

/// How much there is of a wall; as real numbers, for walls beyond any machine are to be told of too.
struct WallSize {
  double columns = 0, rows = 0;
  double bonds = 0;       ///< of the families of all columns, as BondFamilies holds them
  double neighbours = 0;  ///< columns that a column has bonds with, the mean, itself among them
  double rings = 0;       ///< of a polar cross-section, else 0

  double particles() const { return columns * rows; }
};

/// The size of the wall that resolved parameters describe; counted ring by ring or row by row of the
/// cross-section, so exact (but for
/// lattices of more than 1e5 rows, which no machine holds: an upper bound).
WallSize wall_size(const Parameters& p);

/// How a wall is simulated, as far as memory depends on it.
struct WallUse {
  int ranks = 1;         ///< among which one wall is dealt out
  int threads = 1;       ///< of each
  bool outputs = true;   ///< fields are observed and written
  bool doubles = false;  ///< they are written in double precision
  bool checkpoints = false;
};

/// Rows, of each rank, of the piece of the wall that `rhexis check` times.
inline constexpr std::int64_t timed_rows = 64;

/// Bytes of all ranks together, at the moment of most, without what the program and its libraries take.
struct WallMemory {
  double run = 0;
  double check = 0;  ///< `rhexis check`: pieces of the wall, to be timed and for its stability and accuracy
};

WallMemory wall_memory(const Parameters& p, const WallSize& size, const WallUse& use);

}  // namespace rhexis::peridynamics
