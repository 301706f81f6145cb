// SPDX-License-Identifier: BSD-3-Clause
/// Slips of units and digits in a network: what no vessel can be is refused, what hardly any is, told.
#pragma once

#include <string>
#include <vector>

#include "network/graph.hpp"

namespace rhexis::network {

/// Why a pressure (Pa) or a flow (m3/s) given at an end is none of blood in a vessel; empty: it may be.
/// Vessels burst below 1 MPa; the heart of a blue whale pumps less than 1000 L/min.
std::string impossible_condition(BoundaryCondition::Kind kind, double value);

/// Sentences on what is improbable, each with how many vessels or ends are so and the first of them: radii
/// above 3 cm or below 1 um, lengths below the distance of the ends, many branches shorter than their radius,
/// pressures of arteries at ends of capillaries. Throws InputError with every vessel that is shorter than a
/// twentieth of the distance of its ends (less may be in sketches not drawn to scale), and every condition
/// that is impossible.
std::vector<std::string> improbable(const BoundedGraph& network);

}  // namespace rhexis::network
