// SPDX-License-Identifier: BSD-3-Clause
/// Which junctions of a distributed network are on several ranks, who owns them, and what is known there.
///
/// A rendezvous: every rank reports the ids of its junctions to the ranks id mod P, its directory, which
/// answers with what the holders of an id must know of each other. No rank sees more than its share of ids.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hemodynamics/steady/graph/boundary.hpp"
#include "network/graph.hpp"
#include "parallel/shared_values.hpp"

namespace rhexis::hemodynamics {

struct JunctionDirectory {
  std::vector<parallel::SharedLink> links;  ///< in local indices, by ascending rank
  std::vector<bool> connected;              ///< [J] has vessels, on whatever rank
  Boundary boundary;  ///< fixed pressures at every holder; ghosts and inflows at the owner only
};

/// Collective. A condition may be given by any of the ranks that have its junction, or several of them alike.
/// Throws InputError on all ranks where ids or conditions contradict each other.
JunctionDirectory look_up(const network::Graph& local, std::span<const std::int64_t> junction_id,
                          std::span<const network::BoundaryCondition> conditions,
                          parallel::Communicator comm);

}  // namespace rhexis::hemodynamics
