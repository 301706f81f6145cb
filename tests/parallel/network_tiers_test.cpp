// SPDX-License-Identifier: BSD-3-Clause
// One tree pair by three tiers: recursion, explicit graph, graph over all ranks. Every pressure to 1e-10 of
// the pressure difference, every flow to 1e-10 of itself. At 1, 2 and 4 ranks. With
// RHEXIS_TEST_GENERATIONS=24 in the environment (10 GB) it does so for that one size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "hemodynamics/poiseuille.hpp"
#include "hemodynamics/steady/graph/distributed_flow.hpp"
#include "hemodynamics/steady/tree/tree_flow.hpp"
#include "support/trees.hpp"

namespace rhexis::hemodynamics {
namespace {

constexpr double inlet = 12600, outlet = 600, tolerance = 1e-10;
using Kind = network::BoundaryCondition::Kind;

std::vector<double> conductances(const network::Graph& g) {
  std::vector<double> conductance;
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    const double eta = apparent_viscosity(test::in_vivo(), g.radius[v], 0.45);
    conductance.push_back(1 / poiseuille_resistance(g.radius[v], g.length[v], eta));
  }
  return conductance;
}

struct Worst {
  double flow = 0, pressure = 0;
  void compare(const network::Graph& g, std::size_t v, const GraphFlow& f, const VesselFlow& truth) {
    flow = std::max(flow, std::abs(f.flow[v] / truth.flow - 1));
    pressure = std::max({pressure, std::abs(f.pressure[g.from[v]] - truth.pressure_from) / (inlet - outlet),
                         std::abs(f.pressure[g.to[v]] - truth.pressure_to) / (inlet - outlet)});
  }
};

VesselFlow vessel_flow(const std::vector<PlaceFlow>& at, std::uint64_t id) {
  const PlaceFlow& p = at[network::TreePair::place_of(id) - 1];
  if (network::TreePair::kind_of(id) == network::VesselKind::artery)
    return {p.flow, p.artery_near, p.artery_far};
  return {p.flow, p.vein_far, p.vein_near};
}

TEST(NetworkTiers, AgreeInEveryVessel) {
  const auto world = parallel::Communicator::world();
  std::vector<int> sizes{1, 2, 4, 5, 9, 14, 16};
  if (const char* size = std::getenv("RHEXIS_TEST_GENERATIONS")) sizes = {std::stoi(size)};
  for (const int k : sizes) {
    for (const network::TreeRules& rules : {test::plain_rules(k), test::random_rules(k)}) {
      const network::TreePair tree(rules);
      const TreeFlow recursion(tree, test::in_vivo(), {inlet, outlet, {}}, world);
      std::vector<std::uint64_t> places;
      for (std::uint64_t p = 1; p <= tree.places(); ++p) places.push_back(p);
      const auto truth = recursion.at(places);

      const std::int64_t end = std::int64_t{1} << k;
      const network::Graph graph = tree.materialise(false);
      const std::vector<network::BoundaryCondition> conditions{
          {0, Kind::pressure, inlet, 0}, {static_cast<std::uint32_t>(end), Kind::pressure, outlet, 0}};
      const GraphFlow explicit_flow = solve_flow(graph, conductances(graph), conditions);
      Worst worst;
      for (std::uint64_t id = 0; id < tree.vessels(); ++id) {
        worst.compare(graph, id, explicit_flow, vessel_flow(truth, id));
      }
      EXPECT_LT(worst.flow, tolerance) << "explicit, k = " << k;
      EXPECT_LT(worst.pressure, tolerance) << "explicit, k = " << k;

      auto part = tree.materialise_part(world.rank(), world.size());
      const DistributedGraph own{part.graph, part.junction_id};
      std::vector<network::BoundaryCondition> own_conditions;
      for (std::uint32_t j = 0; j < own.local.junctions; ++j) {
        if (own.junction_id[j] == 0) own_conditions.push_back({j, Kind::pressure, inlet, 0});
        if (own.junction_id[j] == end) own_conditions.push_back({j, Kind::pressure, outlet, 0});
      }
      const GraphFlow distributed = solve_flow(own, conductances(own.local), own_conditions, {}, world);
      Worst part_worst;
      for (std::size_t v = 0; v < own.local.vessels(); ++v) {
        part_worst.compare(own.local, v, distributed,
                           vessel_flow(truth, static_cast<std::uint64_t>(part.vessel_id[v])));
      }
      EXPECT_LT(part_worst.flow, tolerance) << "distributed, k = " << k;
      EXPECT_LT(part_worst.pressure, tolerance) << "distributed, k = " << k;
      EXPECT_LT(distributed.max_imbalance, tolerance);
    }
  }
}

TEST(TreeParts, AreTheWholeWithoutGapsOrOverlaps) {
  const network::TreePair tree(test::random_rules(8));
  const network::Graph whole = tree.materialise();
  for (const int parts : {1, 3, 7, 64}) {
    std::vector<int> seen(whole.vessels());
    for (int p = 0; p < parts; ++p) {
      const auto part = tree.materialise_part(p, parts);
      const network::Graph& g = part.graph;
      for (std::size_t v = 0; v < g.vessels(); ++v) {
        const auto id = static_cast<std::size_t>(part.vessel_id[v]);
        ++seen[id];
        EXPECT_EQ(part.junction_id[g.from[v]], whole.from[id]);
        EXPECT_EQ(part.junction_id[g.to[v]], whole.to[id]);
        EXPECT_EQ(g.radius[v], whole.radius[id]);
        EXPECT_EQ(g.length[v], whole.length[id]);
        EXPECT_EQ(g.x[g.to[v]], whole.x[whole.to[id]]);
        EXPECT_EQ(g.z[g.from[v]], whole.z[whole.from[id]]);
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(whole.vessels())) << parts;
  }
}

}  // namespace
}  // namespace rhexis::hemodynamics
