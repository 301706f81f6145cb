// SPDX-License-Identifier: BSD-3-Clause
// What a user can get wrong, and that the message names it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/error.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "networks.hpp"

namespace rhexis::hemodynamics {
namespace {

using networks::inflow;
using networks::pressure;
using Conditions = std::vector<network::BoundaryCondition>;

template <class Error = InputError>
std::string message_of(const network::Graph& graph, const std::vector<double>& conductance,
                       const Conditions& conditions, const GraphSolverOptions& options = {}) {
  try {
    solve_flow(graph, conductance, conditions, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void expect_named(const std::string& message, const std::string& name) {
  EXPECT_NE(message.find(name), std::string::npos) << message;
}

std::string numbered(char letter, std::size_t number) {
  std::string name(1, letter);
  name += std::to_string(number);
  return name;
}

network::Graph named(network::Graph graph) {
  for (std::size_t j = 0; j < graph.junctions; ++j) graph.junction_name.push_back(numbered('j', j));
  for (std::size_t v = 0; v < graph.vessels(); ++v) graph.vessel_name.push_back(numbered('v', v));
  return graph;
}

TEST(GraphErrors, ComponentWithoutPressure) {
  const Conditions conditions{pressure(0, 1), inflow(3, 1)};
  // A tree, a loop that reduction removes, and a core.
  expect_named(message_of(named(networks::graph(5, {{0, 1}, {4, 3}, {3, 2}})), {1, 1, 1}, conditions),
               "junction j2");
  expect_named(
      message_of(named(networks::graph(5, {{0, 1}, {4, 3}, {3, 2}, {2, 4}})), {1, 1, 1, 1}, conditions),
      "junction j2");
  expect_named(message_of(named(networks::graph(6, {{0, 1}, {2, 3}, {2, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}})),
                          std::vector<double>(7, 1.0), conditions),
               "junction j2");
  expect_named(message_of(named(networks::graph(2, {{0, 1}})), {1}, {}), "junction j0");
}

TEST(GraphErrors, Conductances) {
  const auto graph = named(networks::graph(3, {{0, 1}, {1, 2}}));
  for (const double wrong : {0.0, -1.0, double{NAN}, double{INFINITY}}) {
    expect_named(message_of(graph, {1, wrong}, {pressure(0, 1)}), "vessel v1");
  }
  expect_named(message_of(graph, {1}, {pressure(0, 1)}), "1 conductances");
}

TEST(GraphErrors, Vessels) {
  expect_named(message_of(named(networks::graph(3, {{0, 1}, {2, 2}})), {1, 1}, {pressure(0, 1)}),
               "junction j2");
  auto graph = networks::graph(3, {{0, 1}, {1, 3}});
  expect_named(message_of(graph, {1, 1}, {pressure(0, 1)}), "vessel 1");
}

TEST(GraphErrors, ConditionsOfJunctions) {
  const auto graph = named(networks::graph(4, {{0, 1}, {1, 2}}));
  const auto message = [&](const Conditions& conditions) { return message_of(graph, {1, 1}, conditions); };
  expect_named(message({pressure(0, 1), inflow(0, 1)}), "junction j0");
  expect_named(message({pressure(0, 1), pressure(0, 1)}), "junction j0");
  expect_named(message({pressure(0, 1), inflow(3, 1)}), "junction j3");
  expect_named(message({pressure(0, 1), inflow(2, NAN)}), "junction j2");
  expect_named(message({pressure(0, 1), pressure(4, 1)}), "junction 4");
  expect_named(message({pressure(1, 1, -2)}), "junction j1");
  expect_named(message({pressure(1, 1, INFINITY)}), "junction j1");
  expect_named(message({pressure(0, 1), {2, network::BoundaryCondition::Kind::flow, 1, 3}}), "junction j2");
  EXPECT_EQ(message({pressure(0, 1)}), "no error");
}

TEST(GraphErrors, EliminationOfWhatItCannotSolve) {
  const auto graph = networks::graph(4, {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}});
  expect_named(message_of(graph, {1, 1, 1, 1, 1}, {pressure(0, 1), pressure(3, 0)},
                          {.solver = GraphSolver::elimination}),
               "leaves 2 junctions");
  const Conditions ends{pressure(0, 1), pressure(3, 0)};
  const std::vector<std::uint32_t> part(4);
  EXPECT_THROW(check_flow_problem(graph, ends, part, {.solver = GraphSolver::elimination}), InputError);
  check_flow_problem(graph, ends, part);
}

TEST(GraphErrors, ImbalanceNotReached) {
  const auto graph = networks::lattice(10, 1);
  const auto g = networks::conductances(graph.vessels(), 1e12, 1);
  const Conditions conditions{pressure(0, 1), pressure(static_cast<std::uint32_t>(graph.junctions - 1), 0)};
  // Out of iterations; and an imbalance below rounding, which must end rather than go on for ever.
  const auto few =
      message_of<RunError>(graph, g, conditions, {.solver = GraphSolver::jacobi, .max_iterations = 5});
  expect_named(few, "'jacobi' reached an imbalance of");
  expect_named(few, "more iterations");
  for (const auto solver : {GraphSolver::approximate_cholesky, GraphSolver::ldlt}) {
    expect_named(message_of<RunError>(graph, g, conditions, {.solver = solver, .imbalance = 1e-30}),
                 "allow a larger imbalance");
  }
}

}  // namespace
}  // namespace rhexis::hemodynamics
