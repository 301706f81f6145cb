// SPDX-License-Identifier: BSD-3-Clause
/// Whether a wall fits into memory, before any of it is made.
#pragma once

#include <cstdint>
#include <string>

#include "parallel/communicator.hpp"
#include "peridynamics/bonds/wall_size.hpp"
#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

/// How a wall is simulated, as far as memory depends on it.
struct WallUse {
  int ranks = 1;         ///< among which one wall is dealt out
  int threads = 1;       ///< threads of each rank
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

/// Adds up what the parts of a wall tell of themselves.
WallMemory wall_memory(const Parameters& p, const WallSize& size, const WallUse& use);

/// What is asked of memory: walls, and how they are used.
struct WallDemand {
  WallUse use = {};
  bool one_each = false;           ///< every rank has a wall of its own; else all ranks share one
  double variation = 1;            ///< the largest wall's memory, over that of the resolved parameters'
  bool only_checks = false;        ///< `rhexis check`, and no run
  bool geometry_is_given = false;  ///< radii and length are not the input's to change
};

/// Memory of one wall of `resolved` parameters, in bytes, on all ranks that share it.
WallMemory memory_of(const Parameters& resolved, const WallDemand& demand);

/// Throws InputError, of the key that is most likely at fault, where the memory of this machine does not
/// suffice; the message says what would fit. Collective.
void require_memory(const Parameters& resolved, const WallDemand& demand, parallel::Communicator comm);

/// "1,234 MB", or "12 GB" from 10 GB on.
std::string megabytes(double bytes);

}  // namespace rhexis::peridynamics
