// SPDX-License-Identifier: BSD-3-Clause
/// Pressures and flows at ends that no circulation has: slips of units and digits.
#pragma once

#include <string>

#include "core/format.hpp"
#include "network/graph.hpp"

namespace rhexis::network {

/// The largest flow, m3/s, that is taken for one of blood: the heart of a blue whale pumps less.
inline constexpr double largest_flow = 1000 / litres_per_minute;
/// The highest pressure, Pa, relative to atmosphere: vessels burst below it.
inline constexpr double highest_pressure = 1e6;

/// Why a pressure (Pa) or a flow (m3/s) given at an end is none of blood in a vessel; empty: it may be.
std::string impossible_condition(BoundaryCondition::Kind kind, double value);

}  // namespace rhexis::network
