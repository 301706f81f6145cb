// SPDX-License-Identifier: BSD-3-Clause
/// Networks as SWC, the format of tracings: a line "id type x y z radius parent" for each point, parent -1
/// where it has none. Fields are divided by spaces, tabs or commas, comments begin with #, ids come in any
/// order, and there may be several roots. SWC has no unit; tracings are mostly in micrometres. The type (1: a
/// soma) says nothing of a vessel and is not used.
///
/// What lies between two points of which each is a root, a branching or an end is one line, which becomes
/// vessels by the rules of VTP's lines (vtp_network.hpp): one vessel where the radius is constant, else one
/// for each of its segments. Junctions are named by the ids of their points, vessels by the id of the last
/// point of their line: "7", or "7.2" for its third vessel.
#pragma once

#include <filesystem>

#include "network/graph.hpp"

namespace rhexis::network {

/// Throws InputError, naming the file and the line at fault. `merge_tolerance`: see line_merging.hpp.
BoundedGraph read_swc_network(const std::filesystem::path& path, double metres_per_unit,
                              double merge_tolerance);

}  // namespace rhexis::network
