// SPDX-License-Identifier: BSD-3-Clause
/// The rules by which the lines of a VTP file become a network (see vtp_network.hpp); no VTK.
#pragma once

#include <string>

#include "network/files/vtp/interface.hpp"
#include "network/graph.hpp"

namespace rhexis::network {

/// Points this near, as a fraction of the radius of the lumen, are one place (network.merge_tolerance): far
/// below what divides two vessels, far above what tools round or resample.
constexpr double default_merge_tolerance = 0.05;

/// The radius of the cylinder with the Poiseuille resistance of a cone from radius a to b: 1/r^4 is the mean
/// of 1/(a + (b - a) s)^4 over s = 0 .. 1, that is (a^-3 - b^-3) / (3 (b - a)) = (a2 + a b + b2) / (3 a3 b3).
double tapered_radius(double a, double b);

/// The merge tolerance is a fraction of the radius (line_merging.hpp). Vessels from a junction to itself are
/// left out with `drops_self_loops`, else refused. Throws InputError; `file` begins every message.
BoundedGraph network_of_lines(vtp::Lines lines, const std::string& file, double metres_per_unit,
                              double merge_tolerance, bool drops_self_loops = false);

}  // namespace rhexis::network
