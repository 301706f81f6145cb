// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/graph_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "hemodynamics/steady/graph/core_solve.hpp"
#include "hemodynamics/steady/graph/reducible.hpp"
#include "hemodynamics/steady/graph/reduction.hpp"
#include "network/connectivity.hpp"

namespace rhexis::hemodynamics {
namespace {

/// What reduction has left, numbered anew: unknown junctions first, then those of fixed pressure.
struct Core {
  std::vector<std::uint32_t> vessel, junction;  // numbers before
  std::size_t unknowns = 0;
  CoreSystem system;
};

Core core_of(const Reduction& reduction, std::size_t junctions, const std::vector<Boundary::Fixed>& fixed,
             double inflow) {
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> left = reduction.vessels_left(), junction;
  std::vector<std::uint32_t> number(left.empty() ? 0 : junctions, none);
  for (const std::uint32_t v : left) {
    for (const std::uint32_t j : {reduction.tail(v), reduction.head(v)}) {
      if (number[j] != none || reduction.kept(j)) continue;
      number[j] = static_cast<std::uint32_t>(junction.size());
      junction.push_back(j);
    }
  }
  const std::size_t unknowns = junction.size();
  std::vector<double> injection, pressure;
  for (const auto& [j, value] : fixed) {
    if (!number.empty()) number[j] = static_cast<std::uint32_t>(junction.size());
    junction.push_back(j);
    pressure.push_back(value);
  }
  for (const std::uint32_t j : junction) injection.push_back(reduction.injection(j));
  std::vector<CoreVessel> vessels;
  vessels.reserve(left.size());
  for (const std::uint32_t v : left) {
    vessels.push_back({number[reduction.tail(v)], number[reduction.head(v)], reduction.conductance(v)});
  }
  return {std::move(left), std::move(junction), unknowns,
          CoreSystem(unknowns, std::move(vessels), std::move(injection), pressure, inflow)};
}

/// Where the choice is ours, a complete factor that rounding has spoilt gives way to the approximate one,
/// which it cannot spoil; `solver` says so.
std::int64_t solve_by(GraphSolver& solver, CoreSystem& system, const GraphSolverOptions& options) {
  if (options.solver == GraphSolver::automatic && solver == GraphSolver::ldlt) {
    try {
      const auto factor = make_preconditioner(system, solver);
      return solve_core(system, *factor, solver, options);
    } catch (const RunError&) {
      solver = GraphSolver::approximate_cholesky;
      system.spread_fixed_pressures();
    }
  }
  const auto preconditioner = make_preconditioner(system, solver);
  return solve_core(system, *preconditioner, solver, options);
}

/// Pressures and flows, ghosts included; solver, iterations, size of the core.
GraphFlow reduce_and_solve(const network::Graph& graph, std::vector<double> conductance,
                           const Boundary& boundary, const GraphSolverOptions& options, double& resolution) {
  Reduction reduction = reducible(graph, std::move(conductance), boundary, {});
  reduction.reduce();
  if (reduction.floating_junction() != Reduction::none)
    throw_floating(name_of_first(graph, reduction.floating_junction()));
  GraphFlow result;
  {
    const auto fixed = all_fixed(graph, boundary);
    const std::size_t junctions = graph.junctions + boundary.ghosts.size();
    auto [vessel, junction, unknowns, system] =
        core_of(reduction, junctions, fixed, sum_of_inflows(boundary));
    const std::size_t floating = system.spread_fixed_pressures();
    if (floating < unknowns) throw_floating(name_of_first(graph, junction[floating]));
    result.solver = choose_solver(options, unknowns);
    result.core_junctions = static_cast<std::int64_t>(unknowns);
    if (unknowns > 0) result.iterations = solve_by(result.solver, system, options);
    resolution = system.resolution();
    for (std::size_t n = 0; n < junction.size(); ++n) reduction.set_pressure(junction[n], system.pressure(n));
    for (std::size_t n = 0; n < vessel.size(); ++n) reduction.set_flow(vessel[n], system.flow(n));
  }
  reduction.restore();
  result.pressure = reduction.take_pressure();
  result.flow = reduction.take_flow();
  return result;
}

Boundary checked_boundary(const network::Graph& graph, std::span<const network::BoundaryCondition> conditions,
                          const std::vector<bool>& connected) {
  const NameOfJunction name = [&](std::size_t j) { return graph.name_of_junction(j); };
  Boundary boundary = sort_conditions(graph, conditions, name);
  for (const auto& inflow : boundary.inflows) {
    if (!connected[inflow.junction]) throw_inflow_without_vessels(name(inflow.junction));
  }
  return boundary;
}

}  // namespace

void check_flow_problem(const network::Graph& graph, std::span<const network::BoundaryCondition> conditions,
                        std::span<const std::uint32_t> part, const GraphSolverOptions& options) {
  const std::vector<bool> connected = junctions_with_vessels(graph);
  const Boundary boundary = checked_boundary(graph, conditions, connected);
  std::vector<bool> held(graph.junctions);
  for (const auto& fixed : boundary.fixed) held[part[fixed.junction]] = true;
  for (const auto& ghost : boundary.ghosts) held[part[ghost.junction]] = true;
  for (std::uint32_t j = 0; j < graph.junctions; ++j) {
    if (connected[j] && !held[part[j]]) throw_floating(graph.name_of_junction(part[j]));
  }
  if (options.solver != GraphSolver::elimination) return;
  // What is left does not depend on the conductances.
  Reduction reduction = reducible(graph, std::vector<double>(graph.vessels(), 1.0), boundary, {});
  reduction.reduce();
  choose_solver(options, core_of(reduction, graph.junctions + boundary.ghosts.size(),
                                 all_fixed(graph, boundary), sum_of_inflows(boundary))
                             .unknowns);
}

GraphFlow solve_flow(const network::Graph& graph, std::vector<double> conductance,
                     std::span<const network::BoundaryCondition> conditions,
                     const GraphSolverOptions& options) {
  check_vessels(graph, conductance);
  const std::vector<bool> connected = junctions_with_vessels(graph);
  const Boundary boundary = checked_boundary(graph, conditions, connected);
  double resolution = 0;
  GraphFlow result = reduce_and_solve(graph, std::move(conductance), boundary, options, resolution);
  judge(graph, boundary, resolution / options.imbalance, nullptr, result);
  set_pressures_of_conditions(boundary, connected, result.pressure);
  return result;
}

}  // namespace rhexis::hemodynamics
