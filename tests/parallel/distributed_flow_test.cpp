// SPDX-License-Identifier: BSD-3-Clause
// A network cut over ranks has the flows and pressures of the whole: to 1e-10 of the inflow where the rest is
// solved iteratively, to rounding where elimination solves it. Vessels are dealt out in blocks (neat cuts)
// and one by one (nearly every junction shared).
#include "hemodynamics/steady/graph/distributed_flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"
#include "networks.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::hemodynamics {
namespace {

using networks::inflow;
using networks::pressure;
using parallel::Communicator;
using Conditions = std::vector<network::BoundaryCondition>;

enum class Deal { blocks, one_by_one, all_on_last };

/// Ids of junctions in the pieces: spread out, and not in the order of the whole.
std::int64_t id_of(std::uint32_t junction) {
  return (std::int64_t{1} << 40) + std::int64_t{junction} * 7919 % 1000003;
}

struct WallSegment {
  DistributedGraph graph;
  std::vector<double> conductance;
  std::vector<std::uint32_t> vessel, junction;  // in the whole
  Conditions conditions;
};

/// Conditions go to the first of the ranks that have the junction, those of pressure to all.
WallSegment piece_of(const network::Graph& whole, const std::vector<double>& g, const Conditions& conditions,
                     Deal deal) {
  const auto comm = Communicator::world();
  const auto ranks = static_cast<std::size_t>(comm.size()), rank = static_cast<std::size_t>(comm.rank());
  const auto rank_of = [&](std::size_t v) {
    if (deal == Deal::all_on_last) return ranks - 1;
    return deal == Deal::blocks ? v * ranks / whole.vessels() : v * 2654435761u / 64 % ranks;
  };
  std::vector<std::size_t> first_holder(whole.junctions, ranks);
  std::vector<std::uint32_t> local(whole.junctions, 0xffffffff);
  WallSegment piece;
  const auto hold = [&](std::uint32_t j) {
    if (local[j] != 0xffffffff) return local[j];
    local[j] = static_cast<std::uint32_t>(piece.junction.size());
    piece.junction.push_back(j);
    piece.graph.junction_id.push_back(id_of(j));
    return local[j];
  };
  for (std::uint32_t v = 0; v < whole.vessels(); ++v) {
    for (const std::uint32_t j : {whole.from[v], whole.to[v]})
      first_holder[j] = std::min(first_holder[j], rank_of(v));
    if (rank_of(v) != rank) continue;
    piece.vessel.push_back(v);
    piece.conductance.push_back(g[v]);
    piece.graph.local.from.push_back(hold(whole.from[v]));
    piece.graph.local.to.push_back(hold(whole.to[v]));
  }
  for (std::uint32_t j = 0; j < whole.junctions; ++j) {
    if (first_holder[j] == ranks && rank == ranks - 1) hold(j);
  }
  for (auto condition : conditions) {
    const std::uint32_t j = condition.junction;
    const std::size_t first = std::min(first_holder[j], ranks - 1);
    if (local[j] == 0xffffffff || (condition.kind == network::BoundaryCondition::Kind::flow && rank != first))
      continue;
    condition.junction = local[j];
    piece.conditions.push_back(condition);
  }
  piece.graph.local.junctions = piece.junction.size();
  return piece;
}

/// Solves in pieces and as a whole and compares; returns the former.
GraphFlow expect_same(const network::Graph& whole, const std::vector<double>& g, const Conditions& conditions,
                      Deal deal, const GraphSolverOptions& options, double tolerance) {
  const auto comm = Communicator::world();
  const WallSegment piece = piece_of(whole, g, conditions, deal);
  const auto expected = solve_flow(whole, g, conditions, {.imbalance = 1e-14});
  const auto result = solve_flow(piece.graph, piece.conductance, piece.conditions, options, comm);
  EXPECT_NEAR(result.inflow / expected.inflow, 1, tolerance);
  EXPECT_LE(result.max_imbalance, 2 * options.imbalance);
  double flow_error = 0, pressure_error = 0, largest_pressure = 0;
  for (std::size_t v = 0; v < piece.vessel.size(); ++v) {
    flow_error = std::max(flow_error, std::abs(result.flow[v] - expected.flow[piece.vessel[v]]));
  }
  for (std::size_t j = 0; j < piece.junction.size(); ++j) {
    const double there = expected.pressure[piece.junction[j]];
    EXPECT_EQ(std::isnan(there), std::isnan(result.pressure[j]));
    if (std::isnan(there)) continue;
    pressure_error = std::max(pressure_error, std::abs(result.pressure[j] - there));
    largest_pressure = std::max(largest_pressure, std::abs(there));
  }
  EXPECT_EQ(result.flow.size(), piece.vessel.size());
  EXPECT_EQ(result.pressure.size(), piece.junction.size());
  EXPECT_LE(flow_error, tolerance * expected.inflow);
  EXPECT_LE(comm.all_reduce(pressure_error, parallel::Reduce::max),
            1e3 * tolerance * comm.all_reduce(largest_pressure, parallel::Reduce::max));
  return result;
}

std::uint32_t last_of(const network::Graph& graph) {
  return static_cast<std::uint32_t>(graph.junctions - 1);
}

TEST(DistributedFlow, TreePairIsExact) {
  const auto [graph, inlet, outlet] = networks::tree_pair(12);
  const auto g = networks::conductances(graph.vessels(), 1e12, 1);
  for (const Deal deal : {Deal::blocks, Deal::one_by_one, Deal::all_on_last}) {
    const auto result = expect_same(graph, g, {pressure(inlet, 12000), pressure(outlet, 500)}, deal,
                                    {.imbalance = 1e-13}, 1e-12);
    EXPECT_EQ(result.solver, GraphSolver::elimination);
    EXPECT_EQ(result.core_junctions, 0);
  }
}

TEST(DistributedFlow, SmallFlowsOfATreePairAreAsPreciseAsLargeOnes) {
  const auto [graph, inlet, outlet] = networks::tree_pair(10);
  const auto g = networks::conductances(graph.vessels(), 1e12, 1);
  const Conditions conditions{pressure(inlet, 12000), pressure(outlet, 500)};
  const WallSegment piece = piece_of(graph, g, conditions, Deal::one_by_one);
  const auto expected = solve_flow(graph, g, conditions);
  const auto result = solve_flow(piece.graph, piece.conductance, piece.conditions, {}, Communicator::world());
  for (std::size_t v = 0; v < piece.vessel.size(); ++v) {
    ASSERT_NEAR(result.flow[v] / expected.flow[piece.vessel[v]], 1, 1e-12);
  }
}

TEST(DistributedFlow, LatticeGatheredAndInPlace) {
  const auto graph = networks::lattice(14, 3);
  const Conditions conditions{pressure(0, 12000), pressure(last_of(graph), 500)};
  for (const double contrast : {1e3, 1e12}) {
    const auto g = networks::conductances(graph.vessels(), contrast, 4);
    for (const Deal deal : {Deal::blocks, Deal::one_by_one, Deal::all_on_last}) {
      for (const auto solver : {GraphSolver::automatic, GraphSolver::amg}) {
        const auto result =
            expect_same(graph, g, conditions, deal, {.solver = solver, .imbalance = 1e-12}, 1e-10);
        EXPECT_GT(result.iterations, 0);
        EXPECT_EQ(result.solver == GraphSolver::amg, solver == GraphSolver::amg);
      }
    }
  }
}

TEST(DistributedFlow, ConditionsOfAllKinds) {
  const auto graph = networks::lattice(8, 3);
  const auto g = networks::conductances(graph.vessels(), 1e6, 4);
  const Conditions conditions{pressure(0, 3),   pressure(last_of(graph), -2, 0.5),
                              pressure(100, 1), pressure(101, 0.3, 1e-3),
                              inflow(200, 0.5), inflow(150, -0.2),
                              inflow(33, 0.1)};
  for (const Deal deal : {Deal::blocks, Deal::one_by_one}) {
    for (const auto solver : {GraphSolver::automatic, GraphSolver::amg}) {
      expect_same(graph, g, conditions, deal, {.solver = solver, .imbalance = 1e-12}, 1e-10);
    }
  }
}

TEST(DistributedFlow, DeadEndsAcrossRanksAndIsolatedJunctions) {
  // A path 0-1-2-3-4, a side path 2-5-6-7 that ends nowhere, and two junctions on their own.
  const auto graph = networks::graph(10, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {2, 5}, {5, 6}, {6, 7}});
  const Conditions conditions{pressure(0, 4), pressure(4, 0), pressure(9, 17)};
  const std::vector<double> g(graph.vessels(), 2.0);
  for (const auto solver : {GraphSolver::automatic, GraphSolver::amg}) {
    expect_same(graph, g, conditions, Deal::blocks, {.solver = solver}, 1e-10);
  }
  const WallSegment piece = piece_of(graph, g, conditions, Deal::one_by_one);
  const auto result = solve_flow(piece.graph, piece.conductance, piece.conditions, {}, Communicator::world());
  for (std::size_t v = 0; v < piece.vessel.size(); ++v) {
    if (piece.vessel[v] >= 4) {
      EXPECT_EQ(result.flow[v], 0);
    }
  }
}

std::string message_of(const WallSegment& piece, const GraphSolverOptions& options = {}) {
  try {
    solve_flow(piece.graph, piece.conductance, piece.conditions, options, Communicator::world());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void expect_on_all_ranks(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_EQ(Communicator::world().broadcast(message), message);
}

TEST(DistributedFlowErrors, PartsWithoutPressure) {
  // Beside a good vessel: a path, and two tetrahedra joined by a vessel, which are cut over ranks.
  const auto path = networks::graph(6, {{0, 1}, {2, 3}, {3, 4}, {4, 5}});
  const auto tetrahedra = networks::graph(10, {{0, 1},
                                               {2, 3},
                                               {2, 4},
                                               {2, 5},
                                               {3, 4},
                                               {3, 5},
                                               {4, 5},
                                               {5, 6},
                                               {6, 7},
                                               {6, 8},
                                               {6, 9},
                                               {7, 8},
                                               {7, 9},
                                               {8, 9}});
  for (const auto& graph : {path, tetrahedra}) {
    const std::vector<double> g(graph.vessels(), 1.0);
    for (const Deal deal : {Deal::blocks, Deal::one_by_one, Deal::all_on_last}) {
      for (const auto solver : {GraphSolver::automatic, GraphSolver::amg}) {
        expect_on_all_ranks(message_of(piece_of(graph, g, {pressure(0, 1)}, deal), {.solver = solver}),
                            "nothing sets the pressure");
      }
    }
  }
}

TEST(DistributedFlowErrors, OneRanksMistakeIsEveryRanksError) {
  const auto graph = networks::graph(5, {{0, 1}, {1, 2}, {2, 3}, {3, 4}});
  const std::vector<double> g(4, 1.0);
  const bool is_last = Communicator::world().rank() == Communicator::world().size() - 1;
  WallSegment piece = piece_of(graph, g, {pressure(0, 1), pressure(4, 0)}, Deal::blocks);
  const WallSegment good = piece;
  if (is_last) piece.conductance.back() = -1;
  expect_on_all_ranks(message_of(piece), "has conductance -1");
  piece = good;
  if (is_last) piece.graph.junction_id.front() = -5;
  expect_on_all_ranks(message_of(piece), "is negative");
  piece = good;
  if (is_last) piece.conditions.push_back(pressure(77, 1));
  expect_on_all_ranks(message_of(piece), "does not exist");
  EXPECT_EQ(message_of(good), "no error");
}

TEST(DistributedFlowErrors, ConditionsThatContradictEachOther) {
  // Every rank has one vessel of a star whose centre is fixed, by each at a pressure of its own.
  const auto comm = Communicator::world();
  WallSegment piece;
  piece.graph.local = networks::graph(2, {{0, 1}});
  piece.graph.junction_id = {1000, comm.rank()};
  piece.conductance = {1};
  piece.conditions = {pressure(0, comm.rank())};
  EXPECT_EQ(message_of(piece) == "no error", comm.size() == 1);
  if (comm.size() > 1) expect_on_all_ranks(message_of(piece), "junction 1000 has two conditions");
  piece.conditions = {pressure(0, 5)};
  EXPECT_EQ(message_of(piece), "no error");
  piece.graph.junction_id = {1000, 1000};
  expect_on_all_ranks(message_of(piece), "junction 1000 comes twice on one rank");
}

}  // namespace
}  // namespace rhexis::hemodynamics
