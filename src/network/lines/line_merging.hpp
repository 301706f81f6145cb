// SPDX-License-Identifier: BSD-3-Clause
/// Centre lines as tools write them, made a drawing in which every vessel is drawn once and meets its
/// neighbours: tools such as vmtk write one line from the inlet to each outlet, so that trunks are repeated,
/// and leave gaps at branch points. Two places count as one where their distance is at most the tolerance
/// (network.merge_tolerance) times the smaller of the radii there. Lines without repetitions and gaps stay as
/// they are.
#pragma once

#include <string>
#include <vector>

#include "network/lines/line_drawing.hpp"

namespace rhexis::network::vtp {

/// Leaves out the stretches of lines that repeat earlier lines: those that stay within the tolerance of them
/// for at least ten times their largest distance. Lines drawing apart by more than 1 in 10 have parted; they
/// meet at the last point before that. A line of two points between the ends of another one of two points is
/// a parallel vessel and no repetition. Returns sentences for the user.
std::vector<std::string> leave_out_repetitions(LineDrawing& drawing, double metres_per_unit);

/// Joins ends of lines to the nearest line within the tolerance: those that meet nothing and have no
/// condition, if the gap is at most a tenth of their line's length, and those that lie in another part of the
/// network than that line. Returns sentences for the user; they name ends that lie in the lumen of another
/// line but farther from it than the tolerance, which are not joined.
std::vector<std::string> close_gaps(LineDrawing& drawing, double metres_per_unit);

}  // namespace rhexis::network::vtp
