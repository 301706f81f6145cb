// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/network_file.hpp"

#include <algorithm>
#include <string_view>

#include "core/error.hpp"
#include "core/text_encoding.hpp"
#include "core/text_file.hpp"
#include "network/files/swc_network.hpp"
#include "network/files/vtp_network.hpp"
#include "network/repair/drop.hpp"
#include "network/repair/end_conditions.hpp"
#include "network/repair/reference_pressure.hpp"
#include "network/repair/wall_ranges.hpp"
#include "network/survey/plausibility.hpp"

namespace rhexis::network {
namespace {

struct FormatOfFiles {
  std::string_view extension;
  std::size_t files;
  NetworkFormat format;
};

constexpr FormatOfFiles formats[] = {
    {".csv", 2, NetworkFormat::csv},         {".json", 1, NetworkFormat::json},
    {".graphml", 1, NetworkFormat::graphml}, {".dat", 1, NetworkFormat::secomb},
    {".swc", 1, NetworkFormat::swc},         {".vtp", 1, NetworkFormat::vtp},
    {".vtk", 1, NetworkFormat::vtp}};

/// ".csv" of "J.CSV".
std::string extension_of(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

BoundedGraph read_files(const std::vector<std::string>& files, const FileOptions& options) {
  const auto metres_per_unit = [&] { return options.to_si("1 " + options.length_unit, "m"); };
  switch (format_of(files)) {
    case NetworkFormat::csv:
      return read_csv_network(files[0], files[1], options);
    case NetworkFormat::json:
      return read_json_network(files[0], options);
    case NetworkFormat::graphml:
      return read_graphml_network(files[0], options);
    case NetworkFormat::secomb:
      return read_secomb_network(files[0], options);
    case NetworkFormat::swc:
      return read_swc_network(files[0], metres_per_unit(), options.merge_tolerance);
    case NetworkFormat::vtp:
      break;
  }
  return read_vtp_network(files[0], metres_per_unit(), options.merge_tolerance, options.drops_self_loops);
}

}  // namespace

std::string read_network_text(const std::filesystem::path& file) {
  std::string text = plain_text(whole_file(file));
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError(file.string() + ": the file is empty");
  if (text.find('\0') != std::string::npos) throw InputError(file.string() + ": not a text file");
  return text;
}

NetworkFormat format_of(const std::vector<std::string>& files) {
  for (const FormatOfFiles& known : formats) {
    const auto is_of_format = [&](const std::string& file) { return extension_of(file) == known.extension; };
    if (files.size() == known.files && std::ranges::all_of(files, is_of_format)) return known.format;
  }
  throw InputError(
      "name one .json, .graphml, .dat (Secomb's), .swc, .vtp or .vtk file, or two .csv files: first "
      "junctions, then vessels");
}

void check_length_unit(const Parameters& parameters, const std::string& remedy) {
  const NetworkFormat format = format_of(parameters.files);
  const bool can_tell = format != NetworkFormat::vtp && format != NetworkFormat::swc;
  if (can_tell || !parameters.file_length_unit.empty()) return;
  throw InputError("the unit of lengths is needed, which " + parameters.files.front() +
                   " cannot tell: " + remedy);
}

BoundedGraph read_network(const Parameters& parameters, const ToSi& to_si) {
  const auto drops = [&](const char* what) {
    return std::ranges::find(parameters.drop, what) != parameters.drop.end();
  };
  BoundedGraph network = read_files(parameters.files, {.to_si = to_si,
                                                       .length_unit = parameters.file_length_unit,
                                                       .merge_tolerance = parameters.merge_tolerance,
                                                       .drops_self_loops = drops("self_loops")});
  if (network.file.empty()) network.file = parameters.files.back();
  set_end_conditions(parameters.conditions, network);
  refuse_directed_ends(network);
  if (drops("islands")) drop_islands(network);
  if (drops("dead_ends")) drop_dead_ends(network);
  set_reference_pressure(parameters.reference_pressure, network);
  set_wall_ranges(parameters.wall_ranges, network);
  Improbable found = improbable(network);
  network.warnings = std::move(found.warnings);
  network.notes.insert(network.notes.end(), found.notes.begin(), found.notes.end());
  return network;
}

}  // namespace rhexis::network
