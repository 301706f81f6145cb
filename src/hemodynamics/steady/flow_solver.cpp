// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/flow_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/memory.hpp"
#include "hemodynamics/poiseuille.hpp"
#include "network/condition_limits.hpp"
#include "network/tree/tree_pair.hpp"
#include "parallel/node.hpp"
#include "parallel/together.hpp"

namespace rhexis::hemodynamics {

namespace {

std::unique_ptr<FlowSolver> make_solver(const FlowProblem& problem, parallel::Communicator comm) {
  const network::Tier tier = problem.network.resolved_tier();
  if (tier == network::Tier::implicit_tree) return make_implicit_solver(problem, comm);
  if (tier == network::Tier::distributed_graph) return make_distributed_solver(problem, comm);
  return make_explicit_solver(problem, comm);
}

/// Throws InputError where a rank's share of a tree's vessels cannot be numbered, or held in memory.
/// `ranks_here`: that share the memory of this machine.
void check_size(const FlowProblem& problem, int ranks, int ranks_here) {
  const bool distributed = problem.network.tier == network::Tier::distributed_graph;
  const double vessels = static_cast<double>(network::TreePair::vessels_of(problem.tree.generations)) /
                         (distributed ? ranks : 1);
  const MemoryLimit memory = available_memory();
  const int sharing = distributed && memory.of_machine ? ranks_here : 1;
  const double bytes = vessels * bytes_per_vessel;
  if (vessels < 0x1p31 && sharing * bytes < memory.bytes) return;
  throw InputError(
      fmt::format("this tree takes some {:.3g} GB on a rank{}, and {:.3g} GB is left by {}; {} \"implicit\"",
                  1e-9 * bytes, sharing > 1 ? fmt::format(", {} of them here", sharing) : "",
                  1e-9 * memory.bytes, memory.source, distributed ? "take more ranks, or" : "take"),
      "network.tier");
}

std::unique_ptr<FlowSolver> checked_solver_of(const FlowProblem& problem, parallel::Communicator comm) {
  auto solver = make_solver(problem, comm);
  if (problem.builds_tree()) {
    const int ranks_here = parallel::ranks_of_node(comm);
    parallel::together<InputError>(comm, [&] { check_size(problem, comm.size(), ranks_here); });
  }
  return solver;
}

}  // namespace

std::unique_ptr<FlowSolver> checked_solver(const FlowProblem& problem, parallel::Communicator comm) {
  auto solver = checked_solver_of(problem, comm);
  if (!problem.builds_tree()) solver->prepare();
  return solver;
}

std::unique_ptr<FlowSolver> prepared_solver(const FlowProblem& problem, parallel::Communicator comm) {
  auto solver = checked_solver_of(problem, comm);
  solver->prepare();
  return solver;
}

NetworkVessel broadcast(parallel::Communicator comm, const NetworkVessel& vessel, int root) {
  NetworkVessel everywhere;
  static_cast<VesselProperties&>(everywhere) = comm.broadcast<VesselProperties>(vessel, root);
  everywhere.name = comm.broadcast(vessel.name, root);
  return everywhere;
}

void check_flow(NetworkSolution& solution, const std::array<double, 2>& driving) {
  const NetworkFlow& s = solution.flow;
  if (!std::isfinite(s.inflow))
    throw RunError("the flow of this network cannot be computed: it came out as " + text(s.inflow) + " m3/s");
  const auto [low, high] = driving;
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high))))
    solution.warnings.push_back("nothing flows: no difference of pressure drives blood through the network");
  constexpr double atmosphere = 101325;  // Pa; pressures are told from it
  if (s.lowest_pressure < -atmosphere) {
    solution.warnings.push_back(fmt::format(
        "the pressure falls to {}, below vacuum at {}: no fluid flows so; check the flows that are given",
        mmhg(s.lowest_pressure), mmhg(-atmosphere)));
  } else if (s.lowest_pressure < -1e-9 * (high - low)) {
    solution.warnings.push_back(fmt::format(
        "the pressure falls to {}, below that around the vessels: real ones would collapse, these are rigid",
        mmhg(s.lowest_pressure)));
  }
  constexpr double highest_reynolds_of_blood = 2e4;
  if (s.highest_reynolds > highest_reynolds_of_blood || std::abs(s.inflow) > network::largest_flow) {
    solution.warnings.push_back(fmt::format(
        "an inflow of {} L/min and Reynolds numbers up to {} are those of no circulation: are the units of "
        "lengths, pressures and flows right?",
        text(s.inflow * litres_per_minute), text(s.highest_reynolds)));
  } else if (s.highest_reynolds > laminar_reynolds_number) {
    solution.warnings.push_back(
        fmt::format("the Reynolds number reaches {:.0f}; above {:.0f} flow is not laminar, and real "
                    "resistances are higher than those of Eq. (9)",
                    s.highest_reynolds, laminar_reynolds_number));
  }
}

}  // namespace rhexis::hemodynamics
