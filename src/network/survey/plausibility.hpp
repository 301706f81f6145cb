// SPDX-License-Identifier: BSD-3-Clause
/// Slips of units and digits in a network: what no vessel can be is refused, what hardly any is, told.
#pragma once

#include <string>
#include <vector>

#include "network/graph.hpp"

namespace rhexis::network {

/// What is improbable, in sentences with how many vessels or ends are so and the first of them.
struct Improbable {
  std::vector<std::string> warnings, notes;
};

/// Warns of radii above 3 cm or below 1 um, of branches shorter than their radius where these are more than a
/// tenth, and of pressures of arteries at ends of capillaries; notes lengths below the distance of the ends,
/// as sketches have that are not drawn to scale. Throws InputError with every vessel that is shorter than a
/// twentieth of that distance.
Improbable improbable(const BoundedGraph& network);

}  // namespace rhexis::network
