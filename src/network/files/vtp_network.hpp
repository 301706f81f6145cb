// SPDX-License-Identifier: BSD-3-Clause
/// Networks as VTK's PolyData lines (.vtp, or .vtk in the legacy format), the files of ParaView and of centre
/// line tools. VTK is in a plugin (librhexis_vtp.so, see core/plugin.hpp), which is opened by the first call.
///
/// A line becomes one vessel between its end points if its interior points are its own and carry no
/// condition; it is cut at points that it shares with another line (or with itself) and at those with a
/// condition. Where nothing else meets, a line that continues another one is of the same vessel, if the
/// values of cells are those of the other. The vessel has pieces (Graph::pieces) where a point array of radii
/// varies along it by more than 1e-12: one for every segment (see `tapered_radius`). A file whose lines have
/// two points each is a list of vessels, which are not joined.
/// Points that coincide are one, lines that repeat others are left out, gaps at ends of lines are closed
/// (lines/line_merging.hpp). Junctions are the end points of vessels, in the order of the file's
/// points. Where their numbers, or those of vessels, differ from the file's, their names are the file's
/// numbers, from 0: "7" is point or cell 7, "7.2" the third vessel of cell 7.
///
/// Arrays, in the file's unit of length (and Pa, m3/s); all but the radius are optional:
/// - radius, Radius, MaximumInscribedSphereRadius, diameter or Diameter, of cells or points: the first found
/// - length, wall_thickness, of cells; a length is shared out among a line's vessels
/// - kind (0 artery, 1 vein, 2 unknown), generation (-1: unknown, to 127), of cells
/// - pressure_condition, flow_condition (into the network), haematocrit_condition (of the blood that enters
///   where one of the others is known), of points; nan: none (VTK reads nan from binary and appended data
///   only, not from format="ascii")
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "network/graph.hpp"
#include "network/lines/line_network.hpp"

namespace rhexis::network {

/// Whether there is the plugin, without which VTP files are neither read nor written.
bool knows_vtp();

/// Reads a network; throws InputError, naming the file and the cell or point at fault, also where there is
/// no plugin. `merge_tolerance` and `drops_self_loops`: see line_network.hpp.
BoundedGraph read_vtp_network(const std::filesystem::path& path, double metres_per_unit,
                              double merge_tolerance = default_merge_tolerance,
                              bool drops_self_loops = false);

struct NamedArray {
  std::string name;
  std::span<const double> values;
};

/// Writes the graph in metres, each vessel a line of two points, with the arrays that `read_vtp_network`
/// knows (but conditions, which can be among `point_arrays`) and those given: one value a junction, one a
/// vessel. Throws RunError.
void write_vtp_network(const std::filesystem::path& path, const Graph& graph,
                       std::span<const NamedArray> point_arrays, std::span<const NamedArray> cell_arrays);

}  // namespace rhexis::network
