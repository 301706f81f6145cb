// SPDX-License-Identifier: BSD-3-Clause
// Networks that reduction solves completely: closed forms, and an independent recursion in long double.
// Tolerances are a few roundings: nothing is subtracted.
#include "hemodynamics/steady/graph/graph_flow.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "unit/hemodynamics/steady/graph/flow_checks.hpp"

namespace rhexis::hemodynamics {
namespace {

using networks::inflow;
using networks::pressure;
using Conditions = std::vector<network::BoundaryCondition>;

TEST(Elimination, SingleVessel) {
  const auto result =
      solve_flow(networks::graph(2, {{1, 0}}), {2e-9}, Conditions{pressure(0, 300), pressure(1, 100)});
  EXPECT_DOUBLE_EQ(result.flow[0], 2e-9 * -200);
  EXPECT_DOUBLE_EQ(result.inflow, 4e-7);
  EXPECT_EQ(result.max_imbalance, 0);
  EXPECT_EQ(result.solver, GraphSolver::elimination);
  EXPECT_EQ(result.core_junctions, 0);
  EXPECT_EQ(result.pressure, (std::vector<double>{300, 100}));
}

TEST(Elimination, SeriesWithAVesselAgainstTheStream) {
  const auto graph = networks::graph(4, {{0, 1}, {2, 1}, {2, 3}});
  const auto result = solve_flow(graph, {1, 0.5, 0.25}, Conditions{pressure(0, 7), pressure(3, 0)});
  EXPECT_NEAR(result.flow[0], 1, 1e-15);
  EXPECT_NEAR(result.flow[1], -1, 1e-15);
  EXPECT_NEAR(result.flow[2], 1, 1e-15);
  EXPECT_NEAR(result.pressure[1], 6, 1e-14);
  EXPECT_NEAR(result.pressure[2], 4, 1e-14);
}

TEST(Elimination, ParallelVesselsOfBothDirections) {
  const auto graph = networks::graph(3, {{0, 1}, {1, 0}, {0, 1}, {1, 2}});
  const auto result = solve_flow(graph, {1, 2, 3, 6}, Conditions{pressure(0, 2), pressure(2, 0)});
  EXPECT_NEAR(result.flow[0], 1, 1e-15);
  EXPECT_NEAR(result.flow[1], -2, 1e-15);
  EXPECT_NEAR(result.flow[2], 3, 1e-15);
  EXPECT_NEAR(result.flow[3], 6, 1e-15);
  EXPECT_EQ(result.core_junctions, 0);
}

TEST(Elimination, DeadEndsCarryExactlyNothing) {
  // A side tree and a side loop (a lollipop) at the middle of a vessel.
  const auto graph =
      networks::graph(9, {{0, 1}, {1, 2}, {1, 3}, {3, 4}, {3, 5}, {1, 6}, {6, 7}, {7, 8}, {8, 6}});
  const auto result =
      solve_flow(graph, {0.3, 0.7, 1e-9, 3, 5, 7, 11, 13, 17}, Conditions{pressure(0, 100), pressure(2, 1)});
  for (std::size_t v = 2; v < graph.vessels(); ++v) EXPECT_EQ(result.flow[v], 0) << v;
  for (std::size_t j = 3; j < 9; ++j) EXPECT_EQ(result.pressure[j], result.pressure[1]) << j;
  EXPECT_NEAR(result.flow[0], 0.21 * 99, 1e-13);
}

TEST(Elimination, InflowsArePassedOn) {
  // 0 fixed; chain 0-1-2-3 with inflow at 2 and at the end 3, and an outflow at 1.
  const auto graph = networks::graph(4, {{0, 1}, {1, 2}, {2, 3}});
  const Conditions conditions{pressure(0, 10), inflow(1, -4), inflow(2, 1), inflow(3, 2)};
  const auto result = solve_flow(graph, {2, 3, 5}, conditions);
  EXPECT_NEAR(result.flow[2], -2, 1e-15);
  EXPECT_NEAR(result.flow[1], -3, 1e-15);
  EXPECT_NEAR(result.flow[0], 1, 1e-15);
  EXPECT_NEAR(result.inflow, 4, 1e-15);
  EXPECT_NEAR(result.pressure[1], 9.5, 1e-14);
  EXPECT_NEAR(result.pressure[2], 10.5, 1e-14);
  EXPECT_NEAR(result.pressure[3], 10.9, 1e-14);
}

TEST(Elimination, InflowIntoASeriesVesselBetweenPressures) {
  const auto graph = networks::graph(3, {{0, 1}, {1, 2}});
  const Conditions conditions{pressure(0, 1), inflow(1, 6), pressure(2, 2)};
  const auto result = solve_flow(graph, {1, 3}, conditions);
  // (1 + 3) p = 1 + 6 + 6
  EXPECT_NEAR(result.pressure[1], 13.0 / 4, 1e-15);
  EXPECT_NEAR(result.flow[0], 1 - 13.0 / 4, 1e-15);
  EXPECT_NEAR(result.flow[1], 3 * (13.0 / 4 - 2), 1e-15);
  EXPECT_NEAR(result.inflow, 6, 1e-15);
}

TEST(Elimination, PressureBehindAResistance) {
  const auto graph = networks::graph(2, {{0, 1}});
  const Conditions conditions{pressure(0, 12, 2), pressure(1, 2, 3)};
  const auto result = solve_flow(graph, {0.2}, conditions);  // 2 + 5 + 3 = 10 Pa s/m3
  EXPECT_NEAR(result.flow[0], 1, 1e-15);
  EXPECT_NEAR(result.pressure[0], 10, 1e-14);
  EXPECT_NEAR(result.pressure[1], 5, 1e-14);
  EXPECT_NEAR(result.inflow, 1, 1e-15);
  EXPECT_LE(imbalance_of(graph, conditions, result), 1e-14);
  EXPECT_EQ(result.flow.size(), 1u);
  EXPECT_EQ(result.pressure.size(), 2u);
}

TEST(Elimination, ComponentsAndIsolatedJunctions) {
  // Two components, one of a single pressure (nothing flows), and two isolated junctions, one with a
  // pressure.
  const auto graph = networks::graph(8, {{0, 1}, {3, 4}, {4, 5}, {5, 3}});
  const Conditions conditions{pressure(0, 1), inflow(1, 2), pressure(3, 70), pressure(7, 5)};
  const auto result = solve_flow(graph, {4, 1, 1, 1}, conditions);
  EXPECT_TRUE(std::isnan(result.pressure[2]));
  EXPECT_TRUE(std::isnan(result.pressure[6]));
  EXPECT_EQ(result.pressure[7], 5);
  EXPECT_NEAR(result.flow[0], -2, 1e-15);
  for (std::size_t v = 1; v < 4; ++v) EXPECT_EQ(result.flow[v], 0);
  EXPECT_EQ(result.pressure[4], 70);
  EXPECT_NEAR(result.pressure[1], 1.5, 1e-15);
}

TEST(Elimination, EmptyNetwork) {
  const auto result = solve_flow(networks::graph(0, {}), {}, Conditions{});
  EXPECT_EQ(result.inflow, 0);
  EXPECT_EQ(result.max_imbalance, 0);
}

/// Resistance of the pair of subtrees below artery e, by recursion.
long double resistance(const std::vector<double>& g, std::uint32_t past, std::uint32_t e) {
  if (e >= past) return 0;
  const long double own =
      1 / static_cast<long double>(g[e - 1]) + 1 / static_cast<long double>(g[past + e - 2]);
  const long double left = resistance(g, past, 2 * e), right = resistance(g, past, 2 * e + 1);
  return left == 0 ? own : own + left * right / (left + right);
}

TEST(Elimination, TreePairAgainstARecursionInLongDouble) {
  constexpr int generations = 14;
  constexpr std::uint32_t past = 1u << generations;
  const auto [graph, inlet, outlet] = networks::tree_pair(generations);
  const auto g = networks::conductances(graph.vessels(), 1e12, 1);
  const Conditions conditions{pressure(inlet, 12000), pressure(outlet, 500)};
  const auto result = solve_flow(graph, g, conditions);
  EXPECT_EQ(result.core_junctions, 0);
  EXPECT_LE(imbalance_of(graph, conditions, result), 1e-15);
  EXPECT_LE(result.max_imbalance, 1e-15);
  std::vector<long double> through(past);
  through[1] = 11500 / resistance(g, past, 1);
  EXPECT_NEAR(result.inflow / static_cast<double>(through[1]), 1, 1e-14);
  for (std::uint32_t e = 1; e < past; ++e) {
    if (e < past / 2) {
      const long double left = resistance(g, past, 2 * e), right = resistance(g, past, 2 * e + 1);
      through[2 * e] = through[e] * right / (left + right);
      through[2 * e + 1] = through[e] * left / (left + right);
    }
    // Small flows are as precise as large ones: 14 splits of a few roundings each.
    ASSERT_NEAR(result.flow[e - 1] / static_cast<double>(through[e]), 1, 3e-14) << e;
    ASSERT_NEAR(result.flow[past + e - 2] / static_cast<double>(through[e]), 1, 3e-14) << e;
  }
}

TEST(Elimination, ChainOfAMillionJunctions) {
  constexpr std::uint32_t count = 1000000;
  network::Graph graph;
  graph.junctions = count;
  for (std::uint32_t j = 1; j < count; ++j) {
    // In a shuffled order, so that removal does not simply run along the chain.
    const auto at = [](std::uint64_t n) { return static_cast<std::uint32_t>(n * 387420489 % 1000000); };
    graph.from.push_back(at(j - 1));
    graph.to.push_back(at(j));
  }
  const std::uint32_t first = graph.from.front(), last = graph.to.back();
  const auto result = solve_flow(graph, std::vector<double>(graph.vessels(), 2.0),
                                 Conditions{pressure(first, 999999), pressure(last, 0)});
  EXPECT_EQ(result.core_junctions, 0);
  for (const double flow : result.flow) ASSERT_NEAR(flow, 2, 1e-10);  // 1e6 additions of resistance
  EXPECT_NEAR(result.pressure[graph.to[499999]], 499999, 1e-3);
}

TEST(Elimination, StarOfDegreeThousand) {
  network::Graph graph;
  graph.junctions = 1001;
  Conditions conditions;
  for (std::uint32_t j = 1; j <= 1000; ++j) {
    graph.from.push_back(0);
    graph.to.push_back(j);
    conditions.push_back(pressure(j, j));
  }
  const auto result = solve_flow(graph, std::vector<double>(1000, 3.0), conditions);
  EXPECT_EQ(result.core_junctions, 1);
  EXPECT_NEAR(result.pressure[0], 500.5, 1e-11);
  EXPECT_NEAR(result.flow[0], 3 * 499.5, 1e-10);
  EXPECT_LE(result.max_imbalance, 1e-10);
}

double seconds_for(const network::Graph& graph, const Conditions& conditions, GraphFlow& result) {
  const auto start = std::chrono::steady_clock::now();
  result = solve_flow(graph, std::vector<double>(graph.vessels(), 1.0), conditions);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Elimination, HubsTakeLinearTime) {
  // 0 - hub - 200000 paths of two vessels - hub - 1, and as many dead ends at the hubs. Quadratic work would
  // take minutes.
  constexpr std::uint32_t paths = 200000;
  network::Graph graph;
  graph.junctions = 4 + 2 * paths;
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    graph.from.push_back(a);
    graph.to.push_back(b);
  };
  join(0, 2);
  join(3, 1);
  for (std::uint32_t n = 0; n < paths; ++n) {
    join(2, 4 + 2 * n);
    join(4 + 2 * n, 3);
    join(n % 2 == 0 ? 2 : 3, 5 + 2 * n);
  }
  GraphFlow result;
  EXPECT_LT(seconds_for(graph, {pressure(0, 1), pressure(1, 0)}, result), 5);
  EXPECT_EQ(result.core_junctions, 0);
  const double through = 1 / (2 + 2.0 / paths);
  EXPECT_NEAR(result.flow[0], through, 1e-14);
  EXPECT_NEAR(result.flow[2] * paths / through, 1, 1e-11);  // 2e5 conductances are added one by one
  EXPECT_EQ(result.flow[4], 0);
}

}  // namespace
}  // namespace rhexis::hemodynamics
