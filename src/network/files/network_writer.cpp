// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/network_writer.hpp"

#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.hpp"
#include "network/files/vtp_network.hpp"

namespace rhexis::network {
namespace {

using Json = nlohmann::ordered_json;

Json junctions_of(const BoundedGraph& network) {
  const Graph& g = network.graph;
  Json list = Json::array();
  for (std::size_t j = 0; j < g.junctions; ++j) {
    Json junction{{"id", g.name_of_junction(j)}};
    if (!g.junction_label.empty() && !g.junction_label[j].empty()) junction["name"] = g.junction_label[j];
    if (!g.x.empty()) junction.update({{"x", g.x[j]}, {"y", g.y[j]}, {"z", g.z[j]}});
    list.push_back(std::move(junction));
  }
  for (const BoundaryCondition& condition : network.conditions) {
    Json& junction = list[condition.junction];
    const bool is_pressure = condition.kind == BoundaryCondition::Kind::pressure;
    junction[is_pressure ? "pressure" : "flow"] = condition.value;
    if (condition.resistance != 0) junction["resistance"] = condition.resistance;
    if (condition.haematocrit) junction["haematocrit"] = *condition.haematocrit;
  }
  return list;
}

Json vessels_of(const Graph& g) {
  Json list = Json::array();
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    Json vessel{{"id", g.name_of_vessel(v)},
                {"from", g.name_of_junction(g.from[v])},
                {"to", g.name_of_junction(g.to[v])},
                {"radius", g.radius[v]},
                {"length", g.length[v]}};
    if (!g.vessel_label.empty() && !g.vessel_label[v].empty()) vessel["name"] = g.vessel_label[v];
    if (g.knows_wall(v)) vessel["wall_thickness"] = g.wall_thickness[v];
    if (!g.kind.empty() && g.kind[v] != VesselKind::unknown) vessel["kind"] = name_of(g.kind[v]);
    if (!g.generation.empty() && g.generation[v] >= 0) vessel["generation"] = g.generation[v];
    list.push_back(std::move(vessel));
  }
  return list;
}

}  // namespace

BoundedGraph with_vessels_for_pieces(const BoundedGraph& network) {
  const Graph& g = network.graph;
  if (g.piece.empty()) return network;
  BoundedGraph result{.graph = {}, .conditions = network.conditions};
  Graph& all = result.graph;
  all.junctions = g.junctions;
  all.x = g.x, all.y = g.y, all.z = g.z;
  for (std::size_t j = 0; j < g.junctions; ++j) all.junction_name.push_back(g.name_of_junction(j));
  const auto add = [&](std::size_t v, std::uint32_t from, std::uint32_t to, double radius, double length,
                       const std::string& name) {
    all.from.push_back(from);
    all.to.push_back(to);
    all.radius.push_back(radius);
    all.length.push_back(length);
    all.vessel_name.push_back(name);
    if (!g.wall_thickness.empty()) all.wall_thickness.push_back(g.wall_thickness[v]);
    if (!g.kind.empty()) all.kind.push_back(g.kind[v]);
    if (!g.generation.empty()) all.generation.push_back(g.generation[v]);
  };
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    const auto pieces = g.pieces(v);
    const std::string name = g.name_of_vessel(v);
    if (pieces.empty()) add(v, g.from[v], g.to[v], g.radius[v], g.length[v], name);
    std::uint32_t from = g.from[v];
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      std::uint32_t to = g.to[v];
      if (i + 1 < pieces.size()) {
        to = static_cast<std::uint32_t>(all.junctions++);
        const Point& x = pieces[i + 1].start;
        all.x.push_back(x[0]), all.y.push_back(x[1]), all.z.push_back(x[2]);
        all.junction_name.push_back(name + "." + std::to_string(i + 1));
      }
      add(v, from, to, pieces[i].radius, pieces[i].length, name + "." + std::to_string(i));
      from = to;
    }
  }
  if (!g.junction_label.empty()) {
    all.junction_label = g.junction_label;
    all.junction_label.resize(all.junctions);
  }
  return result;
}

std::string json_of(const BoundedGraph& read) {
  const BoundedGraph network = with_vessels_for_pieces(read);
  const Json units{{"length", "m"}, {"pressure", "Pa"}, {"flow", "m3/s"}, {"resistance", "Pa s/m3"}};
  const Json json{
      {"units", units}, {"junctions", junctions_of(network)}, {"vessels", vessels_of(network.graph)}};
  return json.dump(1) + '\n';
}

void check_fits_vtp(const BoundedGraph& network, const std::filesystem::path& path) {
  const auto refuse = [&](const char* what) {
    throw InputError(path.string() + ": a VTP file holds no " + what + "; give a name that ends in .json");
  };
  const Graph& g = network.graph;
  if (g.x.empty()) refuse("network without coordinates");
  if (const std::size_t known = g.known_walls(); known > 0 && known < g.vessels())
    refuse("wall thicknesses of some vessels alone");
  for (const BoundaryCondition& condition : network.conditions)
    if (condition.resistance != 0) refuse("resistances at ends");
}

void write_vtp_network(const std::filesystem::path& path, const BoundedGraph& read) {
  const BoundedGraph network = with_vessels_for_pieces(read);
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> pressure(network.graph.junctions, none), flow = pressure, haematocrit = pressure;
  for (const BoundaryCondition& condition : network.conditions) {
    const bool is_pressure = condition.kind == BoundaryCondition::Kind::pressure;
    (is_pressure ? pressure : flow)[condition.junction] = condition.value;
    haematocrit[condition.junction] = condition.haematocrit.value_or(none);
  }
  const NamedArray of_points[] = {
      {"pressure_condition", pressure}, {"flow_condition", flow}, {"haematocrit_condition", haematocrit}};
  write_vtp_network(path, network.graph, of_points, {});
}

}  // namespace rhexis::network
