// SPDX-License-Identifier: BSD-3-Clause
/// Parts of a network that are left out before its flow is solved, because they carry none.
#pragma once

#include <vector>

#include "network/graph.hpp"

namespace rhexis::network {

/// Leaves out the parts without any pressure or flow (vessels that are joined to each other and to no
/// junction at which one is given). Nothing is left out where no part has one. What is left out is noted.
void drop_islands(BoundedGraph& network);

/// Leaves out vessels that lead to an end without a pressure or flow, then those that lead to them alone, and
/// so on. What is left out is noted. Throws InputError where no vessel is left.
void drop_dead_ends(BoundedGraph& network);

/// Keeps the vessels with `kept`, [V], and of the junctions those that have one of them.
void keep_vessels(BoundedGraph& network, const std::vector<bool>& kept);

}  // namespace rhexis::network
