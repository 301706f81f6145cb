// SPDX-License-Identifier: BSD-3-Clause
/// The rules by which the lines of a VTP file become a network (see vtp_network.hpp); no VTK.
#pragma once

#include <string>

#include "network/graph.hpp"
#include "network/files/vtp/interface.hpp"

namespace rhexis::network {

/// The radius of the cylinder with the Poiseuille resistance of a cone from radius a to b: 1/r^4 is the mean
/// of 1/(a + (b - a) s)^4 over s = 0 .. 1, that is (a^-3 - b^-3) / (3 (b - a)) = (a2 + a b + b2) / (3 a3 b3).
double tapered_radius(double a, double b);

/// Throws InputError; `file` begins every message.
BoundedGraph network_of_lines(const vtp::Lines& lines, const std::string& file, double metres_per_unit);

}  // namespace rhexis::network
