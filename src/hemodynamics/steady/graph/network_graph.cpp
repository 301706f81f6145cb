// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/network_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "core/format.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "network/files/network_file.hpp"
#include "network/names.hpp"
#include "network/tree/tree_pair.hpp"
#include "parallel/communicator.hpp"
#include "parallel/large_array.hpp"
#include "parallel/threads.hpp"

namespace rhexis::hemodynamics {

using network::Graph;
using network::TreePair;

namespace {

void note_unused_haematocrits(const FlowProblem& problem, network::BoundedGraph& network) {
  if (problem.blood.phase_separation) return;
  const auto given = std::ranges::count_if(
      network.conditions, [](const network::BoundaryCondition& c) { return c.haematocrit.has_value(); });
  if (given > 0)
    network.notes.push_back(
        fmt::format("the haematocrits that are given at {} end{} are used only with "
                    "blood.phase_separation = true; now all blood has blood.haematocrit",
                    grouped(given), given > 1 ? "s" : ""));
}

}  // namespace

network::BoundedGraph make_graph_network(const FlowProblem& problem, const Hydrostatic& hydrostatic) {
  network::BoundedGraph network;
  if (problem.network.is_tree()) {
    const TreePair tree(problem.tree);
    network.graph = tree.materialise();
    network.conditions =
        conditions_of(driving_boundary(problem, tree, hydrostatic), 0,
                      static_cast<std::uint32_t>(std::uint64_t{1} << problem.tree.generations));
    return network;
  }
  network = network::read_network(problem.network, problem.to_si);
  note_unused_haematocrits(problem, network);
  const Graph& g = network.graph;
  if (!hydrostatic.acts()) return network;
  if (g.x.empty())
    throw InputError("needs coordinates of the junctions, and the files have none", "flow.acceleration");
  for (network::BoundaryCondition& condition : network.conditions) {
    const std::uint32_t j = condition.junction;
    if (condition.kind == network::BoundaryCondition::Kind::pressure) {
      condition.value -= hydrostatic.pressure(g.x[j], g.y[j], g.z[j]);
    }
  }
  return network;
}

void add_weight(const Graph& g, const Hydrostatic& hydrostatic, std::vector<double>& pressure) {
  if (!hydrostatic.acts()) return;
  for (std::size_t j = 0; j < g.junctions; ++j) pressure[j] += hydrostatic.pressure(g.x[j], g.y[j], g.z[j]);
}

std::array<double, 2> lumen_of(const Graph& g) {
  double volume = 0, surface = 0;
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    g.for_each_piece(v, [&](double radius, double length) {
      const double side = 2 * std::numbers::pi * radius * length;
      surface += side;
      volume += side * radius / 2;
    });
  }
  return {volume, surface};
}

double highest_reynolds_number(const Graph& g, const GraphFlow& flow, const VesselMechanics& mechanics,
                               std::span<const double> haematocrit) {
  double highest = 0;
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    const double h = haematocrit.empty() ? mechanics.viscosity.haematocrit : haematocrit[v];
    g.for_each_piece(v, [&](double radius, double) {
      const double eta = apparent_viscosity(mechanics.viscosity, radius, h);
      highest = std::max(highest, reynolds_number(radius, eta, flow.flow[v], mechanics.hydrostatic.density));
    });
  }
  return highest;
}

std::array<double, 2> extremes_of(const std::vector<double>& pressure) {
  std::array<double, 2> extremes{std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()};
  for (const double p : pressure) {
    if (std::isnan(p)) continue;
    extremes = {std::min(extremes[0], p), std::max(extremes[1], p)};
  }
  return extremes;
}

NetworkVessel describe_vessel(const Graph& g, const GraphFlow& flow, std::uint32_t v,
                              const VesselMechanics& mechanics) {
  NetworkVessel q;
  q.vessel = v;
  if (!g.kind.empty()) q.kind = g.kind[v];
  if (!g.generation.empty()) q.generation = g.generation[v];
  q.radius = g.radius[v];
  q.length = g.length[v];
  q.wall_thickness = wall_thickness(g, v, mechanics);
  q.wall_is_given = g.knows_wall(v);
  if (const auto pieces = g.pieces(v); !pieces.empty()) {
    const auto [least, most] = std::ranges::minmax(pieces, {}, &network::VesselPiece::radius);
    q.sections.emplace();
    for (const auto& [i, radius] : {std::pair(0, least.radius), std::pair(1, most.radius)})
      (*q.sections)[static_cast<std::size_t>(i)] = {radius, wall_thickness_at(g, v, radius, mechanics)};
  }
  q.strength_factor = wall_factors(g, v, mechanics).strength;
  q.flow = flow.flow[v];
  q.pressure_from = flow.pressure[g.from[v]];
  q.pressure_to = flow.pressure[g.to[v]];
  if (!g.x.empty()) {
    q.start = {g.x[g.from[v]], g.y[g.from[v]], g.z[g.from[v]]};
    q.end = {g.x[g.to[v]], g.y[g.to[v]], g.z[g.to[v]]};
  }
  return q;
}

std::vector<double> conductances(const Graph& graph, const Viscosity& viscosity,
                                 std::span<const double> haematocrit) {
  auto conductance = parallel::large_array<double>(graph.vessels());
  parallel::for_each_share(
      parallel::thread_count(), graph.vessels(), [&](int, std::size_t begin, std::size_t end) {
        // Artery and vein of a tree are neighbours and often alike.
        double radius = 0, h = 0, eta = 0;
        for (std::size_t v = begin; v < end; ++v) {
          const double own = haematocrit.empty() ? viscosity.haematocrit : haematocrit[v];
          double resistance = 0;
          graph.for_each_piece(v, [&](double of_piece, double length) {
            if (of_piece != radius || own != h) {
              radius = of_piece;
              h = own;
              eta = apparent_viscosity(viscosity, radius, h);
            }
            resistance += poiseuille_resistance(of_piece, length, eta);
          });
          conductance[v] = 1 / resistance;
        }
      });
  return conductance;
}

std::uint32_t find_vessel(const FlowProblem& problem, const Graph& graph, const std::string& name,
                          const std::string& key) {
  if (problem.is_tree()) {
    try {
      return static_cast<std::uint32_t>(TreePair::id_of(name, problem.tree.generations));
    } catch (const InputError& error) {
      throw InputError(error.what(), key);
    }
  }
  std::optional<std::uint32_t> found;
  check_key(key.c_str(), [&] { found = network::find_vessel(graph, name); });
  if (found) return *found;
  throw InputError("there is no vessel '" + name + "' in " + problem.network.files.back(), key);
}

std::vector<std::uint32_t> widest_vessels(const Graph& graph, std::size_t count) {
  std::vector<std::uint32_t> vessels(graph.vessels());
  std::iota(vessels.begin(), vessels.end(), 0u);
  if (count >= vessels.size()) return vessels;
  const auto wider = [&](std::uint32_t a, std::uint32_t b) {
    return graph.radius[a] != graph.radius[b] ? graph.radius[a] > graph.radius[b] : a < b;
  };
  std::nth_element(vessels.begin(), vessels.begin() + static_cast<std::ptrdiff_t>(count), vessels.end(),
                   wider);
  vessels.resize(count);
  std::sort(vessels.begin(), vessels.end());
  return vessels;
}

}  // namespace rhexis::hemodynamics
