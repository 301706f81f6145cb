// SPDX-License-Identifier: BSD-3-Clause
/// Steady flow in an explicit network: Eq. (9) in every vessel, conservation of blood at every junction
/// (Sec. 3.3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/enum_names.hpp"
#include "network/graph.hpp"

namespace rhexis::hemodynamics {

/// How what is left after reduction (see reduction.hpp) is solved. `elimination`: nothing may be left, as on
/// trees and series-parallel networks.
enum class GraphSolver : std::uint8_t { automatic, elimination, ldlt, approximate_cholesky, jacobi, amg };

constexpr auto name_table(GraphSolver) {
  using enum GraphSolver;
  return std::to_array<Named<GraphSolver>>({{automatic, "auto"},
                                            {elimination, "elimination"},
                                            {ldlt, "ldlt"},
                                            {approximate_cholesky, "approximate_cholesky"},
                                            {jacobi, "jacobi"},
                                            {amg, "amg"}});
}

struct GraphSolverOptions {
  GraphSolver solver = GraphSolver::automatic;
  double imbalance = 1e-10;             ///< stop: worst junction's imbalance relative to the inflow
  std::int64_t max_iterations = 20000;  ///< allowed to an iterative solver, in all
};

struct GraphFlow {
  std::vector<double>
      pressure;  ///< [J] relative to atmosphere, Pa; nan at a junction without vessels and condition
  std::vector<double> flow;  ///< [V] m3/s, positive along from -> to
  double inflow = 0;         ///< m3/s, sum of all flows into the network through its conditions
  double max_imbalance = 0;  ///< the largest at any junction, relative to `inflow`
  GraphSolver solver = GraphSolver::automatic;  ///< that was used
  std::int64_t iterations = 0;                  ///< taken by an iterative solver, in all
  std::int64_t core_junctions = 0;              ///< unknowns left after reduction
};

/// Throws the InputError that `solve_flow` would throw of conditions, components and solver, without solving
/// anything. `part`: [J] as of network::first_of_part.
void check_flow_problem(const network::Graph& graph, std::span<const network::BoundaryCondition> conditions,
                        std::span<const std::uint32_t> part, const GraphSolverOptions& options = {});

/// Pressures and flows for conductances [V] in m3/(s Pa). `conductance` is consumed (its memory is reused).
/// 1. Series, parallel and dead-end vessels are removed exactly (reduction.hpp); trees and series-parallel
///    networks are solved by that alone, flows to rounding, however small.
/// 2. What is left is solved by the chosen solver (preconditioner.hpp) inside iterative refinement
///    (core_solve.hpp), until the imbalance asked for is reached by the flows that are returned.
/// Throws InputError, naming junction or vessel, for: a component that has vessels but no condition of
/// pressure; a conductance that is not positive and finite; a vessel from a junction to itself or to one that
/// does not exist; two conditions at one junction; a flow into a junction without vessels; solver
/// `elimination` where junctions are left. Throws RunError where the imbalance asked for is not reached.
/// Solver `amg` needs MPI to be initialised. The same input gives the same digits with any number of threads.
GraphFlow solve_flow(const network::Graph& graph, std::vector<double> conductance,
                     std::span<const network::BoundaryCondition> conditions,
                     const GraphSolverOptions& options = {});

}  // namespace rhexis::hemodynamics
