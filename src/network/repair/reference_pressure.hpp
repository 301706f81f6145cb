// SPDX-License-Identifier: BSD-3-Clause
/// Parts of a network at whose ends flows alone are known: these give every flow and every difference of
/// pressure, but not the pressure itself.
#pragma once

#include <optional>

#include "network/graph.hpp"

namespace rhexis::network {

/// The flows of such a part have to sum to zero within this share of what flows in.
inline constexpr double largest_flow_residual = 1e-3;

/// Puts `pressure` (Pa) in the place of the largest flow out of each part that has flows and no pressure;
/// what flows there follows from the others. A note says where. Throws InputError, of the key
/// network.reference_pressure, where the flows of such a part do not sum to zero. Without a pressure nothing
/// is done.
void set_reference_pressure(std::optional<double> pressure, BoundedGraph& network);

}  // namespace rhexis::network
