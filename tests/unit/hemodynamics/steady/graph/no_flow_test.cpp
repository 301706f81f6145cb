// SPDX-License-Identifier: BSD-3-Clause
// Vessels that carry no flow by the shape of their network carry none in its solution; all others do.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "network/connectivity.hpp"
#include "networks.hpp"

using namespace rhexis;
using namespace rhexis::hemodynamics;

TEST(NoFlow, DeadEndsAndHangingLoopsCarryExactlyNothing) {
  // The way 0-1-2; at 1 a dead end that bifurcates and ends in a loop.
  const network::Graph g =
      networks::graph(8, {{0, 1}, {1, 2}, {1, 3}, {3, 4}, {3, 5}, {5, 6}, {6, 7}, {7, 5}});
  const std::vector conditions{networks::pressure(0, 1e4), networks::pressure(2, 1e3)};
  const GraphFlow flow = solve_flow(g, std::vector<double>(8, 1e-9), conditions);
  const std::vector<bool> carries = network::can_carry_flow(g, conditions);
  for (std::size_t v = 0; v < g.vessels(); ++v) EXPECT_EQ(carries[v], flow.flow[v] != 0) << v;
  EXPECT_NEAR(flow.flow[0], 0.5e-9 * 9e3, 1e-20);
}

TEST(NoFlow, AgreesWithTheSolutionOfRandomNetworks) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> conductance(1, 2), pressure(1, 2);
  std::size_t with = 0, without = 0;
  for (int trial = 0; trial < 300; ++trial) {
    constexpr std::uint32_t junctions = 14;
    std::uniform_int_distribution<std::uint32_t> any(0, junctions - 1);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> vessels;
    // A random tree, so that every part has a condition, and some vessels more.
    for (std::uint32_t j = 1; j < junctions; ++j) vessels.emplace_back(any(random) % j, j);
    for (int more = 0; more < trial % 7; ++more) {
      const std::uint32_t a = any(random), b = any(random);
      if (a != b) vessels.emplace_back(a, b);
    }
    const network::Graph g = networks::graph(junctions, vessels);
    std::vector<double> g_of(vessels.size());
    for (double& value : g_of) value = conductance(random);
    std::vector<network::BoundaryCondition> conditions{networks::pressure(3, pressure(random))};
    if (trial % 3 > 0) conditions.push_back(networks::inflow(7, pressure(random)));
    if (trial % 3 > 1) conditions.push_back(networks::pressure(9, pressure(random), 1));
    const GraphFlow flow = solve_flow(g, g_of, conditions);
    const std::vector<bool> carries = network::can_carry_flow(g, conditions);
    for (std::size_t v = 0; v < g.vessels(); ++v) {
      ++(carries[v] ? with : without);
      // Loops that no series or parallel rule removes are solved to rounding.
      EXPECT_EQ(carries[v], std::abs(flow.flow[v]) > 1e-13) << "trial " << trial << ", vessel " << v;
    }
  }
  EXPECT_GT(with, 500u);
  EXPECT_GT(without, 500u);
}
