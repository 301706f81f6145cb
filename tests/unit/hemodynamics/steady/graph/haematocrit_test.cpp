// SPDX-License-Identifier: BSD-3-Clause
// Red cells at bifurcations, and the fixed point of haematocrit, viscosity and flow.
#include "hemodynamics/steady/graph/haematocrit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hemodynamics/phase_separation.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "support/trees.hpp"

namespace rhexis::hemodynamics {
namespace {

TEST(PhaseSeparation, ConservesCellsWhicheverDaughterIsAsked) {
  for (const double parent : {8.0, 15.0, 60.0}) {
    for (const double a : {5.0, 8.0, 14.0}) {
      for (double f = 0; f <= 1.0001; f += 0.05) {
        const double one = red_cell_fraction(f, 0.4, parent, a, 9),
                     two = red_cell_fraction(1 - f, 0.4, parent, 9, a);
        EXPECT_NEAR(one + two, 1, 1e-12) << parent << " " << a << " " << f;
      }
    }
  }
}

TEST(PhaseSeparation, Limits) {
  EXPECT_EQ(red_cell_fraction(0.5, 0.45, 10, 8, 8), 0.5);
  EXPECT_EQ(red_cell_fraction(0.01, 0.45, 10, 8, 8), 0);  // below the threshold no cell enters
  EXPECT_EQ(red_cell_fraction(0.99, 0.45, 10, 8, 8), 1);
  EXPECT_NEAR(red_cell_fraction(0.3, 0.45, 1e6, 8, 8), 0.3, 1e-4);  // wide vessels divide cells as blood
  EXPECT_GT(red_cell_fraction(0.7, 0.45, 10, 8, 8), 0.7);  // the faster branch gets more than its share
  // By hand: Dp = 10, Da = 6, Db = 8, H = 0.45, f = 0.4.
  EXPECT_NEAR(red_cell_fraction(0.4, 0.45, 10, 6, 8), 0.3953, 1e-4);
  EXPECT_EQ(red_cell_fraction(0.6, 0.1, 1.0, 1, 1), 1);
}

struct Problem {
  network::Graph graph;
  std::vector<network::BoundaryCondition> conditions;

  GraphFlow solve(std::span<const double> haematocrit) const {
    std::vector<double> conductance;
    for (std::size_t v = 0; v < graph.vessels(); ++v) {
      const double eta = apparent_viscosity(test::in_vivo(), graph.radius[v], haematocrit[v]);
      conductance.push_back(1 / poiseuille_resistance(graph.radius[v], graph.length[v], eta));
    }
    return solve_flow(graph, conductance, conditions, {.imbalance = 1e-13});
  }
};

Problem random_tree(int generations) {
  network::TreeRules rules = test::random_rules(generations);
  rules.root_radius = 25e-6;
  Problem p;
  p.graph = network::TreePair(rules).materialise();
  using Kind = network::BoundaryCondition::Kind;
  p.conditions = {{0, Kind::pressure, 8000, 0}, {std::uint32_t{1} << generations, Kind::pressure, 2000, 0}};
  return p;
}

/// Cells in minus cells out of every junction but the ends.
double worst_imbalance(const Problem& p, const HaematocritFlow& r) {
  std::vector<double> cells(p.graph.junctions);
  for (std::size_t v = 0; v < p.graph.vessels(); ++v) {
    cells[p.graph.from[v]] -= r.flow.flow[v] * r.haematocrit[v];
    cells[p.graph.to[v]] += r.flow.flow[v] * r.haematocrit[v];
  }
  for (const network::BoundaryCondition& c : p.conditions) cells[c.junction] = 0;
  double worst = 0;
  for (const double c : cells) worst = std::max(worst, std::abs(c));
  return worst / r.flow.inflow;
}

TEST(Haematocrit, FixedPointOfATreeConservesCells) {
  const Problem p = random_tree(7);
  const auto solve = [&](std::span<const double> h) { return p.solve(h); };
  const HaematocritFlow r = find_haematocrit(p.graph, solve, {});
  EXPECT_TRUE(r.converged) << r.iterations << " " << r.change;
  EXPECT_LT(worst_imbalance(p, r), 1e-13);
  double least = 1, most = 0;
  for (const double h : r.haematocrit) {
    least = std::min(least, h);
    most = std::max(most, h);
  }
  EXPECT_LT(least, 0.35);  // unequal bifurcations do separate
  EXPECT_GT(most, 0.5);
  EXPECT_NEAR(r.haematocrit[0], 0.45, 1e-12);
  EXPECT_NEAR(r.haematocrit[1], 0.45, 1e-12);  // all that went in comes out
  // A fixed point: the flow of these haematocrits carries these haematocrits.
  const std::vector<double> again = carried_haematocrit(p.graph, p.solve(r.haematocrit), 0.45);
  for (std::size_t v = 0; v < again.size(); ++v) EXPECT_NEAR(again[v], r.haematocrit[v], 1e-6);
}

TEST(Haematocrit, SymmetricBifurcationsChangeNothing) {
  Problem p = random_tree(5);
  p.graph = network::TreePair(test::plain_rules(5)).materialise();
  p.conditions[1].junction = 32;
  const HaematocritFlow r =
      find_haematocrit(p.graph, [&](std::span<const double> h) { return p.solve(h); }, {});
  EXPECT_EQ(r.iterations, 1);
  for (const double h : r.haematocrit) EXPECT_NEAR(h, 0.45, 1e-12);
}

TEST(Haematocrit, WhatTheSolverLeavesAtABifurcationIsNoInflow) {
  network::Graph g;
  g.junctions = 4;
  g.from = {0, 1, 1};
  g.to = {1, 2, 3};
  g.radius = {8e-6, 5e-6, 6e-6};
  g.length = {1e-4, 1e-4, 1e-4};
  GraphFlow flow;
  flow.pressure = {4000, 3000, 2000, 2000};
  flow.flow = {1e-14, 3e-15, 7e-15};
  flow.inflow = 1e-14;
  const std::vector<double> exact = carried_haematocrit(g, flow, 0.45);
  EXPECT_LT(exact[1], 0.43);  // the bifurcation does separate
  EXPECT_GT(exact[2], 0.455);
  flow.flow[2] += 1e-7 * flow.inflow;
  flow.max_imbalance = 1e-7;
  const std::vector<double> found = carried_haematocrit(g, flow, 0.45);
  for (std::size_t v = 0; v < 3; ++v) EXPECT_NEAR(found[v], exact[v], 1e-6) << v;
}

TEST(Haematocrit, NotConvergingIsReportedAndCellsAreConservedAllTheSame) {
  const Problem p = random_tree(6);
  HaematocritOptions options;
  options.max_iterations = 2;
  const HaematocritFlow r = find_haematocrit(
      p.graph, [&](std::span<const double> h) { return p.solve(h); }, options);
  EXPECT_FALSE(r.converged);
  EXPECT_EQ(r.iterations, 2);
  EXPECT_GT(r.change, options.tolerance);
  EXPECT_GT(r.mean_change, 0);
  EXPECT_LE(r.mean_change, r.change);
  EXPECT_LT(worst_imbalance(p, r), 1e-13);
}

TEST(Haematocrit, LoopsOfCapillariesConverge) {
  // A square lattice of narrow vessels, fed and drained at its rim: haematocrits of vessels whose flow is
  // slow or near to its reversal oscillate under the plain iteration.
  constexpr std::uint32_t side = 12;
  std::mt19937_64 random(4);
  std::lognormal_distribution<double> radius(std::log(6e-6), 0.45);
  std::uniform_real_distribution<double> pressure(2000, 7000), entering(0.2, 0.55);
  network::BoundedGraph network;
  network::Graph& g = network.graph;
  g.junctions = side * side;
  const auto add = [&](std::uint32_t from, std::uint32_t to) {
    g.from.push_back(from);
    g.to.push_back(to);
    g.radius.push_back(radius(random));
    g.length.push_back(1e-4);
  };
  for (std::uint32_t i = 0; i < side; ++i) {
    for (std::uint32_t j = 0; j < side; ++j) {
      // Every other vessel of a column is left out, so that three vessels meet at a junction.
      if (j + 1 < side) add(i * side + j, i * side + j + 1);
      if (i + 1 < side && (i + j) % 2 == 0) add(i * side + j, (i + 1) * side + j);
    }
  }
  using Kind = network::BoundaryCondition::Kind;
  for (std::uint32_t i = 0; i < side; i += 2) {
    for (const std::uint32_t j : {i * side, i * side + side - 1})
      network.conditions.push_back({j, Kind::pressure, pressure(random), 0, entering(random)});
  }
  const Problem p{network.graph, network.conditions};
  const HaematocritFlow r =
      find_haematocrit(p.graph, [&](std::span<const double> h) { return p.solve(h); },
                       {.inflow_haematocrit = 0.4, .entering = entering_haematocrit(network, 0.4)});
  EXPECT_TRUE(r.converged) << r.change;
  EXPECT_LT(r.iterations, 200);
  EXPECT_LT(worst_imbalance(p, r), 1e-13);
}

TEST(Haematocrit, InletsBringTheirOwn) {
  // 0 and 1 flow into 2, from there all flows on to 3, where 4 joins with the usual haematocrit.
  network::BoundedGraph network;
  network.graph.junctions = 6;
  network.graph.from = {0, 1, 2, 4, 3};
  network.graph.to = {2, 2, 3, 3, 5};
  network.graph.radius = std::vector<double>(5, 10e-6);
  network.graph.length = std::vector<double>(5, 1e-4);
  using Kind = network::BoundaryCondition::Kind;
  network.conditions = {{0, Kind::flow, 1e-13, 0, 0.3},
                        {1, Kind::flow, 3e-13, 0, 0.0},
                        {4, Kind::flow, 4e-13, 0, std::nullopt},
                        {5, Kind::pressure, 1000, 0, 0.6}};  // nothing enters there
  const Problem p{network.graph, network.conditions};
  const HaematocritFlow r =
      find_haematocrit(p.graph, [&](std::span<const double> h) { return p.solve(h); },
                       {.inflow_haematocrit = 0.4, .entering = entering_haematocrit(network, 0.4)});
  EXPECT_TRUE(r.converged);
  const double expected[] = {0.3, 0, 0.3 / 4, 0.4, (0.3 + 4 * 0.4) / 8};
  for (std::size_t v = 0; v < 5; ++v) EXPECT_NEAR(r.haematocrit[v], expected[v], 1e-12) << v;
  // Of inlets without any, nothing is kept for each junction.
  for (network::BoundaryCondition& condition : network.conditions) condition.haematocrit.reset();
  EXPECT_TRUE(entering_haematocrit(network, 0.4).empty());
}

TEST(Haematocrit, DeadEndsKeepTheInflowsHaematocrit) {
  Problem p = random_tree(3);
  p.graph.from.push_back(3);
  p.graph.to.push_back(static_cast<std::uint32_t>(p.graph.junctions++));
  p.graph.radius.push_back(10e-6);
  p.graph.length.push_back(1e-4);
  const HaematocritFlow r =
      find_haematocrit(p.graph, [&](std::span<const double> h) { return p.solve(h); }, {});
  EXPECT_TRUE(r.converged);
  EXPECT_EQ(r.flow.flow.back(), 0);
  EXPECT_EQ(r.haematocrit.back(), 0.45);
}

}  // namespace
}  // namespace rhexis::hemodynamics
