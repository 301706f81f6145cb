// SPDX-License-Identifier: BSD-3-Clause
// Networks with loops that reduction cannot remove, by every solver: closed forms, long double, each other.
// The stop is relative to the inflow, so tolerances are multiples of it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "unit/hemodynamics/steady/graph/flow_checks.hpp"

namespace rhexis::hemodynamics {
namespace {

using networks::inflow;
using networks::pressure;
using Conditions = std::vector<network::BoundaryCondition>;

class Core : public testing::TestWithParam<GraphSolver> {
 protected:
  GraphFlow solve(const network::Graph& graph, const std::vector<double>& g, const Conditions& conditions,
                  double imbalance = 1e-12) {
    const auto result = solve_flow(graph, g, conditions, {.solver = GetParam(), .imbalance = imbalance});
    EXPECT_LE(imbalance_of(graph, conditions, result), 2 * imbalance);
    EXPECT_LE(result.max_imbalance, imbalance + 1e-15);
    return result;
  }
};

INSTANTIATE_TEST_SUITE_P(Solvers, Core,
                         testing::Values(GraphSolver::automatic, GraphSolver::ldlt,
                                         GraphSolver::approximate_cholesky, GraphSolver::jacobi,
                                         GraphSolver::amg),
                         [](const auto& solver) { return std::string(name_of(solver.param)); });

TEST_P(Core, WheatstoneBridge) {
  const auto graph = networks::graph(4, {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}});
  const double a = 1, b = 2, c = 3, d = 4, e = 5;
  const auto result = solve(graph, {a, b, c, d, e}, {pressure(0, 1), pressure(3, 0)});
  // (a+c+d) p1 - c p2 = a,  (b+c+e) p2 - c p1 = b
  const double determinant = (a + c + d) * (b + c + e) - c * c;
  const double p1 = (a * (b + c + e) + c * b) / determinant, p2 = ((a + c + d) * b + c * a) / determinant;
  EXPECT_NEAR(result.pressure[1], p1, 1e-12);
  EXPECT_NEAR(result.pressure[2], p2, 1e-12);
  EXPECT_NEAR(result.flow[2], c * (p1 - p2), 2e-12);
  EXPECT_EQ(result.core_junctions, 2);
}

TEST_P(Core, BalancedBridgeCarriesNothing) {
  const auto graph = networks::graph(4, {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}});
  const auto result = solve(graph, {1, 2, 1e3, 3, 6}, {pressure(0, 1), pressure(3, 0)});
  EXPECT_NEAR(result.flow[2], 0, 1e-12);
}

TEST_P(Core, CubeFromCornerToCorner) {
  network::Graph graph;
  graph.junctions = 8;
  for (std::uint32_t j = 0; j < 8; ++j) {
    for (const std::uint32_t bit : {1u, 2u, 4u}) {
      if ((j & bit) != 0) continue;
      graph.from.push_back(j);
      graph.to.push_back(j | bit);
    }
  }
  const auto result = solve(graph, std::vector<double>(12, 1.0), {inflow(0, 6), pressure(7, 0)});
  EXPECT_NEAR(result.pressure[0], 6 * 5.0 / 6, 1e-11);  // resistance 5/6
  EXPECT_NEAR(result.flow[0], 2, 1e-11);
  EXPECT_NEAR(result.inflow, 6, 0);
}

TEST_P(Core, SeveralConditionsAgainstLongDouble) {
  const auto graph = networks::lattice(6, 3);
  ASSERT_GT(graph.junctions, 150u);
  const auto last = static_cast<std::uint32_t>(graph.junctions - 1);
  const auto g = networks::conductances(graph.vessels(), 1e6, 4);
  const Conditions conditions{pressure(0, 3), pressure(last, -2), pressure(70, 1), inflow(100, 0.5),
                              inflow(30, -0.2)};
  const auto exact = reference(graph, g, conditions);
  const auto result = solve(graph, g, conditions);
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    ASSERT_NEAR(result.flow[v], static_cast<double>(exact.flow[v]), 1e-10 * result.inflow) << v;
  }
}

TEST_P(Core, ContrastOf1e15AgainstLongDouble) {
  const auto graph = networks::lattice(6, 7);
  const auto last = static_cast<std::uint32_t>(graph.junctions - 1);
  const auto g = networks::conductances(graph.vessels(), 1e15, 8);
  const Conditions conditions{pressure(0, 12000), pressure(last, 500)};
  const auto exact = reference(graph, g, conditions);
  const auto result = solve(graph, g, conditions, 1e-11);
  // Pressure differences of long double have 64 bits: flows in the widest vessels are known to 1e-4 of the
  // inflow only there, so pressures are compared, and flows by their imbalance (in `solve`).
  for (std::size_t j = 0; j < graph.junctions; ++j) {
    ASSERT_NEAR(result.pressure[j], static_cast<double>(exact.pressure[j]), 1e-7 * 11500) << j;
  }
}

TEST_P(Core, OneDominantPath) {
  // A ladder with one rail 1e12 times as wide as all else.
  network::Graph graph;
  std::vector<double> g;
  const auto join = [&](std::uint32_t a, std::uint32_t b, double conductance) {
    graph.from.push_back(a);
    graph.to.push_back(b);
    g.push_back(conductance);
  };
  constexpr std::uint32_t rungs = 50;
  graph.junctions = 2 * rungs;
  for (std::uint32_t n = 0; n < rungs; ++n) {
    if (n + 1 < rungs) join(n, n + 1, 1e12);
    if (n + 1 < rungs) join(rungs + n, rungs + n + 1, 1);
    join(n, rungs + n, 1);
    if (n + 2 < rungs) join(n, rungs + n + 2, 1);
  }
  const auto result = solve(graph, g, {pressure(0, 1), pressure(rungs - 1, 0)});
  EXPECT_NEAR(result.inflow, 1e12 / (rungs - 1), 100);
  for (std::uint32_t n = 0; n < rungs; ++n) {
    EXPECT_NEAR(result.pressure[n], 1 - n / (rungs - 1.0), 1e-9);
  }
}

TEST_P(Core, ComponentHeldByAThread) {
  // Two cubes; the second hangs on the first by 1e-15 of a vessel and has an inflow that only the thread can
  // carry away.
  network::Graph graph;
  graph.junctions = 16;
  std::vector<double> g;
  for (std::uint32_t j = 0; j < 16; ++j) {
    for (const std::uint32_t bit : {1u, 2u, 4u}) {
      if ((j & bit) != 0) continue;
      graph.from.push_back(j);
      graph.to.push_back(j | bit);
      g.push_back(1 + 0.1 * j);
    }
  }
  graph.from.push_back(7);
  graph.to.push_back(8);
  g.push_back(1e-15);
  const auto result = solve(graph, g, {pressure(0, 0), inflow(15, 1)}, 1e-10);
  EXPECT_NEAR(result.flow.back(), -1, 1e-9);
  EXPECT_NEAR(result.pressure[8] / 1e15, 1, 1e-9);
}

TEST_P(Core, AllSolversAgreeOnALatticeOfContrast1e12) {
  const auto graph = networks::lattice(28, 5);
  ASSERT_GT(graph.junctions, 20000u);
  const auto last = static_cast<std::uint32_t>(graph.junctions - 1);
  const auto g = networks::conductances(graph.vessels(), 1e12, 6);
  const Conditions conditions{pressure(0, 12000), pressure(last, 500)};
  const auto other = GetParam() == GraphSolver::amg ? GraphSolver::approximate_cholesky : GraphSolver::amg;
  const auto expected = solve_flow(graph, g, conditions, {.solver = other, .imbalance = 1e-14});
  const auto result = solve(graph, g, conditions, 1e-13);
  EXPECT_LE(largest_difference(result.flow, expected.flow), 1e-10 * expected.inflow);
  EXPECT_GT(result.iterations, 0);
  EXPECT_GT(result.core_junctions, 10000);
}

TEST(CoreAlone, ParallelVesselsInTheCoreAreSplit) {
  const auto graph = networks::graph(4, {{0, 1}, {0, 2}, {1, 2}, {2, 1}, {1, 3}, {2, 3}});
  const auto one = networks::graph(4, {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}});
  const Conditions conditions{pressure(0, 1), pressure(3, 0)};
  const auto two_vessels = solve_flow(graph, {1, 2, 1, 2, 4, 5}, conditions);
  const auto one_vessel = solve_flow(one, {1, 2, 3, 4, 5}, conditions);
  EXPECT_NEAR(two_vessels.flow[2], one_vessel.flow[2] / 3, 1e-15);
  EXPECT_NEAR(two_vessels.flow[3], -one_vessel.flow[2] * 2 / 3, 1e-15);
}

TEST(CoreAlone, RandomSmallNetworksAgainstLongDouble) {
  // Trees with some vessels added, parallel ones among them: every rule of reduction meets every other.
  std::mt19937_64 random(17);
  const auto below = [&](std::uint32_t bound) { return static_cast<std::uint32_t>(random() % bound); };
  for (int n = 0; n < 2000; ++n) {
    const std::uint32_t junctions = 2 + below(12);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> vessels;
    for (std::uint32_t j = 1; j < junctions; ++j) vessels.emplace_back(j, below(j));
    for (std::uint32_t extra = below(12); extra > 0; --extra) {
      const std::uint32_t a = below(junctions), b = below(junctions);
      if (a != b) vessels.emplace_back(a, b);
    }
    const auto graph = networks::graph(junctions, vessels);
    const auto g = networks::conductances(graph.vessels(), 1e3, static_cast<unsigned>(n));
    Conditions conditions{pressure(0, 2)};
    for (std::uint32_t j = 1; j < junctions; ++j) {
      const std::uint32_t kind = below(6);
      if (kind == 0) conditions.push_back(pressure(j, below(5)));
      if (kind == 1) conditions.push_back(inflow(j, 1.0 + below(3)));
      if (kind == 2) conditions.push_back(inflow(j, -0.5));
    }
    const auto exact = reference(graph, g, conditions);
    const auto result = solve_flow(graph, g, conditions, {.imbalance = 1e-14});
    for (std::size_t v = 0; v < graph.vessels(); ++v) {
      ASSERT_NEAR(result.flow[v], static_cast<double>(exact.flow[v]), 1e-11 * result.inflow + 1e-300) << n;
    }
    for (std::size_t j = 0; j < junctions; ++j) {
      ASSERT_NEAR(result.pressure[j], static_cast<double>(exact.pressure[j]),
                  1e-9 * (1 + result.inflow) * 1e3)
          << n;
    }
  }
}

TEST(CoreAlone, EveryContrastIsSolvedByOneOfTheTwoFactors) {
  const auto graph = networks::lattice(9, 2);
  const auto last = static_cast<std::uint32_t>(graph.junctions - 1);
  for (const double contrast : {1e9, 1e12, 1e15, 1e18, 1e21, 1e24}) {
    const auto g = networks::conductances(graph.vessels(), contrast, 1);
    const Conditions conditions{pressure(0, 12000), pressure(last, 500)};
    for (const auto solver : {GraphSolver::automatic, GraphSolver::approximate_cholesky}) {
      const auto result = solve_flow(graph, g, conditions, {.solver = solver});
      EXPECT_LE(imbalance_of(graph, conditions, result), 1.1e-10) << contrast;
    }
  }
}

TEST(CoreAlone, EqualPressuresMoveNothing) {
  const auto graph = networks::lattice(8, 2);
  const auto last = static_cast<std::uint32_t>(graph.junctions - 1);
  const auto result = solve_flow(graph, networks::conductances(graph.vessels(), 1e12, 1),
                                 Conditions{pressure(0, 0.1), pressure(last, 0.1)});
  for (const double flow : result.flow) ASSERT_EQ(flow, 0);
  EXPECT_EQ(result.max_imbalance, 0);
}

TEST(CoreAlone, SameAnswerTwice) {
  const auto graph = networks::lattice(12, 2);
  const auto last = static_cast<std::uint32_t>(graph.junctions - 1);
  const auto g = networks::conductances(graph.vessels(), 1e12, 1);
  const Conditions conditions{pressure(0, 1), pressure(last, 0)};
  EXPECT_EQ(solve_flow(graph, g, conditions).flow, solve_flow(graph, g, conditions).flow);
}

}  // namespace
}  // namespace rhexis::hemodynamics
