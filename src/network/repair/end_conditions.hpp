// SPDX-License-Identifier: BSD-3-Clause
/// Conditions at the ends of a network from the input file, [[condition]], where the network's own files lack
/// them or are to be overridden.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "network/graph.hpp"

namespace rhexis::network {

/// A section [[condition]].
struct EndCondition {
  std::string junction = {};         ///< id or name; empty: `nearest`
  std::vector<double> nearest = {};  ///< m, a point whose nearest end is meant
  std::optional<double> pressure = {}, flow = {}, resistance = {},
                        haematocrit = {};  ///< as of BoundaryCondition
};

ParameterList declare(std::vector<EndCondition>& conditions);

/// Throws InputError with the key at fault for values that do not fit together.
void check(const std::vector<EndCondition>& conditions);

/// Puts the conditions in the place of the file's, or adds them; of a pressure or flow that the file gives,
/// one without either changes the haematocrit alone. An end is a junction of one vessel. Throws InputError
/// with the key at fault where there is no such junction, or two are given for one.
void set_end_conditions(const std::vector<EndCondition>& conditions, BoundedGraph& network);

/// Throws InputError with the ends of which the file tells only the direction of the flow, and which no
/// condition has been given since. Thereafter none of them is told.
void refuse_directed_ends(BoundedGraph& network);

}  // namespace rhexis::network
