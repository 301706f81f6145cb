// SPDX-License-Identifier: BSD-3-Clause
/// Steady flow in a network that no single machine holds: graph_flow.hpp over the ranks of a communicator.
///
/// Each rank reduces its own part exactly (reduction.hpp), keeping the junctions that it shares with others.
/// What is left of all parts together is
///  - gathered on every rank and solved there as by one rank, where it is small: tree pairs, whose rest is a
///    small network of their cut branches, stay exact;
///  - else solved where it is: conjugate gradients over the ranks, preconditioned by hypre's BoomerAMG,
///  refined
///    in two doubles as in core_solve.hpp.
/// Then every rank puts back its own part.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::hemodynamics {

/// One rank's vessels, and the junctions that these touch.
struct DistributedGraph {
  network::Graph local;
  std::vector<std::int64_t> junction_id;  ///< [J] the same junction has the same id on every rank; >= 0
};

/// Vessels left of all ranks together up to which the rest is gathered.
inline constexpr std::int64_t largest_to_gather = 400000;

/// Collective. As `solve_flow` for one graph; `conditions` name local junctions, and are given by at least
/// one of the ranks that have the junction. Pressures and flows are those of the rank's own junctions and
/// vessels; all else in the result concerns the whole network and is the same on every rank, as are errors.
/// Solver `amg` always solves in place; the others, which are of one rank, always gather; `automatic` goes by
/// size.
GraphFlow solve_flow(const DistributedGraph& graph, std::vector<double> conductance,
                     std::span<const network::BoundaryCondition> conditions,
                     const GraphSolverOptions& options, parallel::Communicator comm);

}  // namespace rhexis::hemodynamics
