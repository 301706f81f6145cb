// SPDX-License-Identifier: BSD-3-Clause
/// How the junctions and vessels of a graph hang together: parts, ends, and the vessels that can carry flow.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "network/graph.hpp"

namespace rhexis::network {

/// [J] the junction of the lowest number in the part (the connected component) of each junction. A junction
/// without vessels is a part of its own. Takes O(J + V).
std::vector<std::uint32_t> first_of_part(const Graph& graph);

/// [J] the number of vessels at each junction.
std::vector<std::uint32_t> degrees(const Graph& graph);

/// Whether blood can enter or leave at a condition: at every one but a flow of zero, which closes an end.
bool is_open(const BoundaryCondition& condition);

/// [V] whether a vessel can carry flow, whatever the values of the conditions: whether a way from one open
/// condition to another leads through it that passes no junction twice. The others are dead ends, or loops
/// that hang at a single junction; each carries nothing. Takes O(J + V).
std::vector<bool> can_carry_flow(const Graph& graph, std::span<const BoundaryCondition> conditions);

}  // namespace rhexis::network
