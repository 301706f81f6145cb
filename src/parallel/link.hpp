// SPDX-License-Identifier: BSD-3-Clause
/// What the network between ranks can do.
#pragma once

#include <optional>

#include "parallel/communicator.hpp"

namespace rhexis::parallel {

struct Link {
  double latency_s;      ///< time of an empty message
  double bandwidth_B_s;  ///< bandwidth of long messages
};

/// Between the first rank and the last, the best of several messages to and fro; none for one rank. Takes
/// some milliseconds. Collective; the same on all ranks.
std::optional<Link> measure_link(const Communicator& comm);

}  // namespace rhexis::parallel
