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

std::string json_of(const BoundedGraph& network) {
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
  for (const BoundaryCondition& condition : network.conditions) {
    if (condition.resistance != 0) refuse("resistances at ends");
    if (condition.haematocrit) refuse("haematocrits at ends");
  }
}

void write_vtp_network(const std::filesystem::path& path, const BoundedGraph& network) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> pressure(network.graph.junctions, none), flow = pressure;
  for (const BoundaryCondition& condition : network.conditions) {
    const bool is_pressure = condition.kind == BoundaryCondition::Kind::pressure;
    (is_pressure ? pressure : flow)[condition.junction] = condition.value;
  }
  const NamedArray of_points[] = {{"pressure_condition", pressure}, {"flow_condition", flow}};
  write_vtp_network(path, network.graph, of_points, {});
}

}  // namespace rhexis::network
