// SPDX-License-Identifier: BSD-3-Clause
/// Whether a wall fits into memory, before any of it is made.
#pragma once

#include "parallel/communicator.hpp"
#include "peridynamics/engine/memory.hpp"
#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

/// What is asked of memory: walls, and how they are used.
struct WallDemand {
  WallUse use = {};
  bool one_each = false;           ///< every rank has a wall of its own; else all ranks share one
  double variation = 1;            ///< the largest wall's memory, over that of the resolved parameters'
  bool only_checks = false;        ///< `rhexis check`, and no run
  bool geometry_is_given = false;  ///< radii and length are not the input's to change
};

/// Of one wall of `resolved` parameters, bytes of the ranks that share it.
WallMemory memory_of(const Parameters& resolved, const WallDemand& demand);

/// Throws InputError, of the key that is most likely at fault, where the memory of this machine does not
/// suffice; the message says what would fit. Collective.
void require_memory(const Parameters& resolved, const WallDemand& demand, parallel::Communicator comm);

/// "1,234 MB", or "12 GB" from 10 GB on.
std::string megabytes(double bytes);

}  // namespace rhexis::peridynamics
