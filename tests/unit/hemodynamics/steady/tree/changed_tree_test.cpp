// SPDX-License-Identifier: BSD-3-Clause
// A tree with changed and leaking vessels: by its ways alone, against the whole as an explicit graph.
#include "hemodynamics/steady/tree/changed_tree.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "support/trees.hpp"

namespace rhexis::hemodynamics {
namespace {

constexpr double inlet = 12600, outlet = 600;

/// All vessels explicitly, each changed one cut in half.
ChangedTree::Result by_graph(const network::TreePair& tree, const std::vector<VesselChange>& changes,
                             const TreeBoundary& given = {inlet, outlet, {}}) {
  network::Graph graph = tree.materialise(false);
  std::vector<double> conductance;
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    const double eta = apparent_viscosity(test::in_vivo(), graph.radius[v], 0.45);
    conductance.push_back(1 / poiseuille_resistance(graph.radius[v], graph.length[v], eta));
  }
  const auto end = static_cast<std::uint32_t>(std::size_t{1} << tree.generations());
  using Kind = network::BoundaryCondition::Kind;
  std::vector<network::BoundaryCondition> conditions = conditions_of(given, 0, end);
  std::vector<std::size_t> second;
  for (const VesselChange& c : changes) {
    const auto middle = static_cast<std::uint32_t>(graph.junctions++);
    second.push_back(graph.vessels());
    graph.from.push_back(middle);
    graph.to.push_back(graph.to[c.vessel]);
    graph.to[c.vessel] = middle;
    conductance[c.vessel] *= 2 / c.resistance_factor;
    conductance.push_back(conductance[c.vessel]);
    if (c.leak_conductance > 0) {
      conditions.push_back({middle, Kind::pressure, c.outside_pressure, 1 / c.leak_conductance});
    }
  }
  const GraphFlow flow = solve_flow(graph, conductance, conditions, {.imbalance = 1e-13});
  ChangedTree::Result result{flow.flow[0], flow.flow[1], {}};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const std::uint32_t middle = graph.from[second[i]];
    result.vessels.push_back(
        {flow.flow[changes[i].vessel], flow.flow[second[i]],
         changes[i].leak_conductance * (flow.pressure[middle] - changes[i].outside_pressure),
         flow.pressure[graph.from[changes[i].vessel]], flow.pressure[middle],
         flow.pressure[graph.to[second[i]]]});
    if (changes[i].vessel == 1) result.outflow = flow.flow[second[i]];
  }
  return result;
}

TEST(ChangedTree, AgreesWithTheWholeGraph) {
  const network::TreePair tree(test::random_rules(13));
  const TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, parallel::Communicator::world());
  // Root, its vein, neighbours of one bifurcation, both sides of the midplane, a last vessel; leaks to two
  // pressures.
  const std::vector<VesselChange> changes{{0, 1.5, 0, 0},       {1, 0.7, 1e-12, -500},  {2, 1, 3e-11, 0},
                                          {5, 2, 0, 0},         {77, 1, 1e-13, 1000},   {76, 0.5, 0, 0},
                                          {16380, 1, 1e-15, 0}, {16381, 1, 2e-15, 200}, {8190, 10, 0, 0}};
  for (std::size_t count = 0; count <= changes.size(); ++count) {
    const std::vector<VesselChange> some(changes.begin(),
                                         changes.begin() + static_cast<std::ptrdiff_t>(count));
    std::vector<std::uint64_t> vessels{16001};  // announced, but never changed
    for (const VesselChange& c : some) vessels.push_back(c.vessel);
    const ChangedTree::Result a = ChangedTree(flow, vessels).solve(some), b = by_graph(tree, some);
    EXPECT_NEAR(a.inflow / b.inflow, 1, 1e-12) << count;
    EXPECT_NEAR(a.outflow / b.outflow, 1, 1e-12) << count;
    double leaks = 0;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_NEAR(a.vessels[i].flow_from, b.vessels[i].flow_from, 1e-12 * a.inflow);
      EXPECT_NEAR(a.vessels[i].leak, b.vessels[i].leak, 1e-12 * a.inflow);
      EXPECT_NEAR(a.vessels[i].pressure_from, b.vessels[i].pressure_from, 1e-8);
      EXPECT_NEAR(a.vessels[i].pressure_middle, b.vessels[i].pressure_middle, 1e-8);
      EXPECT_NEAR(a.vessels[i].pressure_to, b.vessels[i].pressure_to, 1e-8);
      EXPECT_NEAR(a.vessels[i].flow_from - a.vessels[i].flow_to, a.vessels[i].leak, 1e-13 * a.inflow);
      leaks += a.vessels[i].leak;
    }
    EXPECT_NEAR(a.inflow - a.outflow, leaks, 1e-13 * a.inflow);
  }
}

TEST(ChangedTree, KeepsTheFlowThatIsGiven) {
  const network::TreePair tree(test::random_rules(10));
  const double flow =
      TreeFlow(tree, test::in_vivo(), {inlet, outlet, {}}, parallel::Communicator::world()).flow();
  const std::vector<VesselChange> changes{{2, 1.5, 3e-11, 0}, {77, 2, 1e-12, -500}};
  for (const TreeBoundary& given : {TreeBoundary{{}, outlet, flow}, TreeBoundary{inlet, {}, flow}}) {
    const TreeFlow before(tree, test::in_vivo(), given, parallel::Communicator::world());
    const ChangedTree::Result a = ChangedTree(before, {2, 77}).solve(changes),
                              b = by_graph(tree, changes, given);
    EXPECT_NEAR((given.inlet_pressure ? a.outflow : a.inflow) / flow, 1, 1e-12);
    EXPECT_NEAR(a.inflow, b.inflow, 1e-12 * flow);
    EXPECT_NEAR(a.outflow, b.outflow, 1e-12 * flow);
    EXPECT_GT(a.inflow, 1.01 * a.outflow);
    for (std::size_t i = 0; i < changes.size(); ++i) {
      EXPECT_NEAR(a.vessels[i].leak, b.vessels[i].leak, 1e-12 * flow);
      EXPECT_NEAR(a.vessels[i].pressure_middle, b.vessels[i].pressure_middle, 1e-8);
    }
  }
}

TEST(ChangedTree, WithoutChangeIsTheTreeItself) {
  const network::TreePair tree(test::random_rules(16));
  const TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, parallel::Communicator::world());
  const ChangedTree::Result r = ChangedTree(flow, {40001}).solve({{40001, 1, 0, 0}});
  EXPECT_NEAR(r.inflow / flow.flow(), 1, 1e-13);
  const VesselFlow v = flow.query(40001);
  EXPECT_NEAR(r.vessels[0].flow_from / v.flow, 1, 1e-12);
  EXPECT_NEAR(r.vessels[0].pressure_from, v.pressure_from, 1e-9);
}

TEST(ChangedTree, WholeBodyOfAlikeVessels) {
  const network::TreePair tree(test::plain_rules(34));
  const TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, parallel::Communicator::world());
  const std::uint64_t last = tree.vessels() - 2;
  const ChangedTree::Result r = ChangedTree(flow, {last}).solve({{last, 1, 1e-17, 0}});
  EXPECT_GT(r.vessels[0].leak, 0);
  EXPECT_LT(r.vessels[0].pressure_middle, flow.query(last).pressure_from);
}

TEST(ChangedTree, RefusesWhatItDoesNotKnow) {
  const network::TreePair tree(test::plain_rules(5));
  const TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, parallel::Communicator::world());
  EXPECT_THROW(ChangedTree(flow, {62}), InputError);
  EXPECT_THROW(ChangedTree(flow, {3, 3}), InputError);
  EXPECT_THROW(ChangedTree(flow, {3}).solve({{4, 1, 0, 0}}), InputError);
}

}  // namespace
}  // namespace rhexis::hemodynamics
