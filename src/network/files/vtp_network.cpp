// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/vtp_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/error.hpp"
#include "core/plugin.hpp"
#include "network/lines/line_network.hpp"

namespace rhexis::network {
namespace {

/// The plugin's function of that name; throws Error where there is no plugin.
template <class Function, class Error>
Function* plugin_function(const char* symbol, const std::filesystem::path& path, const char* doing) {
  std::string reason;
  // Local and lazy: nobody else's search for VTK's symbols is to change.
  static void* plugin = nullptr;
  if (plugin == nullptr) plugin = open_plugin(vtp::library, RTLD_LAZY | RTLD_LOCAL, reason);
  auto* function = plugin == nullptr ? nullptr : reinterpret_cast<Function*>(dlsym(plugin, symbol));
  if (function == nullptr) {
    throw Error(fmt::format(
        "{}: {} VTP files needs ParaView's VTK when Rhexis is built (Debian: paraview-dev); {}",
        path.string(), doing, reason.empty() ? std::string("no ") + symbol + " in the plugin" : reason));
  }
  return function;
}

void add(std::vector<vtp::Array>& arrays, const std::string& name, std::span<const double> values,
         std::size_t count, const std::filesystem::path& path) {
  if (values.size() != count) {
    throw RunError(
        fmt::format("{}: array {} has {} values, not {}", path.string(), name, values.size(), count));
  }
  arrays.push_back({name, 1, false, {values.begin(), values.end()}});
}

vtp::Lines lines_of(const Graph& graph, const std::filesystem::path& path) {
  if (graph.x.size() != graph.junctions || graph.y.size() != graph.junctions ||
      graph.z.size() != graph.junctions) {
    throw RunError(path.string() + ": a network whose junctions have no positions cannot be a VTP file");
  }
  vtp::Lines lines;
  for (std::size_t j = 0; j < graph.junctions; ++j) {
    lines.coordinates.insert(lines.coordinates.end(), {graph.x[j], graph.y[j], graph.z[j]});
  }
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    lines.connectivity.insert(lines.connectivity.end(), {graph.from[v], graph.to[v]});
    lines.offsets.push_back(static_cast<std::int64_t>(lines.connectivity.size()));
  }
  auto& arrays = lines.cell_arrays;
  add(arrays, "radius", graph.radius, graph.vessels(), path);
  add(arrays, "length", graph.length, graph.vessels(), path);
  if (graph.known_walls() > 0) add(arrays, "wall_thickness", graph.wall_thickness, graph.vessels(), path);
  if (!graph.kind.empty()) {
    arrays.push_back({"kind", 1, true, {}});
    for (const VesselKind kind : graph.kind) arrays.back().values.push_back(static_cast<double>(kind));
  }
  if (!graph.generation.empty())
    arrays.push_back({"generation", 1, true, {graph.generation.begin(), graph.generation.end()}});
  return lines;
}

/// What a file begins or ends with, at most 256 bytes.
std::string edge_of(const std::filesystem::path& path, bool of_end) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg(), length = std::min<std::streamoff>(size, 256);
  std::string text(static_cast<std::size_t>(std::max<std::streamoff>(length, 0)), ' ');
  file.seekg(of_end ? size - length : 0).read(text.data(), length);
  return text;
}

}  // namespace

bool knows_vtp() {
  return has_plugin(vtp::library);
}

BoundedGraph read_vtp_network(const std::filesystem::path& path, double metres_per_unit,
                              double merge_tolerance, bool drops_self_loops) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) throw InputError(path.string() + ": no such file");
  auto* read = plugin_function<vtp::Read, InputError>(vtp::read_symbol, path, "reading");
  vtp::Lines lines;
  std::string error;
  const bool is_legacy = edge_of(path, false).starts_with("# vtk DataFile");
  read(path.string(), is_legacy ? vtp::Format::legacy : vtp::Format::xml, lines, error);
  if (error.find("too short") != std::string::npos || error.find(": nan") != std::string::npos)
    error += " (VTK cannot read nan or inf written as text)";
  // VTK itself does not see that the last block of a file was cut short.
  if (error.empty() && !is_legacy && edge_of(path, true).find("</VTKFile>") == std::string::npos)
    error = "it does not end in </VTKFile>";
  if (!error.empty()) {
    throw InputError(fmt::format("{}: not a complete {} file of PolyData: {}", path.string(),
                                 is_legacy ? "legacy VTK" : "VTP", error));
  }
  return network_of_lines(std::move(lines), path.string(), metres_per_unit, merge_tolerance,
                          drops_self_loops);
}

void write_vtp_network(const std::filesystem::path& path, const Graph& graph,
                       std::span<const NamedArray> point_arrays, std::span<const NamedArray> cell_arrays) {
  vtp::Lines lines = lines_of(graph, path);
  for (const auto& [name, values] : point_arrays)
    add(lines.point_arrays, name, values, graph.junctions, path);
  for (const auto& [name, values] : cell_arrays) add(lines.cell_arrays, name, values, graph.vessels(), path);
  auto* write = plugin_function<vtp::Write, RunError>(vtp::write_symbol, path, "writing");
  std::string error;
  write(path.string(), lines, error);
  if (!error.empty()) throw RunError(path.string() + ": cannot be written: " + error);
}

}  // namespace rhexis::network
