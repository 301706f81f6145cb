// SPDX-License-Identifier: BSD-3-Clause
/// Networks of the user's own, read from files.
///
/// CSV: two files, each with a header row that names columns (in any order; network_builder.hpp has the
/// names) and, in brackets, their units; see core/csv_table.hpp.
/// - junctions: id; optional: name, x [mm], y [mm], z [mm]; pressure [mmHg] or flow [mL/min] (into the
///   network); resistance [Pa s/m3] (of a peripheral bed behind which the pressure lies); haematocrit
/// - vessels: id, from, to, radius [um] or diameter [um]; optional: name, length [mm] (else the distance of
///   the ends), wall_thickness [um], kind (artery, vein, unknown), generation
///
/// JSON: lists "junctions" and "vessels" of objects with the same names, and the units of all in "units":
///   {"units": {"length": "mm", "pressure": "mmHg", "flow": "mL/min", "resistance": "Pa s/m3"},
///    "junctions": [{"id": "a", "x": 0}], "vessels": [{"id": 1, "from": "a", "to": "b", "radius": 0.1}]}
/// The unit of a kind that no member uses may be left out.
///
/// GraphML: see graphml_network.cpp. Secomb's .dat: see secomb_network.cpp. SWC: see
/// swc_network.hpp. VTP and legacy VTK: see vtp_network.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "network/files/network_builder.hpp"
#include "network/graph.hpp"
#include "network/parameters.hpp"

namespace rhexis::network {

/// Each throws InputError naming the file, line or member, value, and what is allowed, of all that is wrong
/// at once.
BoundedGraph read_csv_network(const std::filesystem::path& junctions, const std::filesystem::path& vessels,
                              const FileOptions& options);
BoundedGraph read_json_network(const std::filesystem::path& file, const FileOptions& options);
BoundedGraph read_graphml_network(const std::filesystem::path& file, const FileOptions& options);
BoundedGraph read_secomb_network(const std::filesystem::path& file, const FileOptions& options);

/// `vtp`: VTK's PolyData, as XML (.vtp) or in the legacy format (.vtk).
enum class NetworkFormat { csv, json, graphml, secomb, swc, vtp };

/// By number and extensions (in any case) of the files. Throws InputError where they are no network's.
NetworkFormat format_of(const std::vector<std::string>& files);

/// Throws InputError, which ends in `remedy`, where files of that format never tell the unit of their lengths
/// and `parameters` do not either.
void check_length_unit(const Parameters& parameters, const std::string& remedy);

/// The network of `parameters.files`, as the solvers take it: read, then repaired as the keys of [network]
/// ask for. The one way in from a user's files. Throws InputError.
BoundedGraph read_network(const Parameters& parameters, const ToSi& to_si);

/// The whole text of a file, as core/text_encoding.hpp has it; throws InputError where it cannot be read or
/// is empty.
std::string read_network_text(const std::filesystem::path& file);

}  // namespace rhexis::network
