// SPDX-License-Identifier: BSD-3-Clause
/// The steady flow in a network together with what a scene asks of it besides: which vessels are at risk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hemodynamics/steady/flow_solver.hpp"
#include "studies/screening/network_screening.hpp"

namespace rhexis::studies {

/// How a network's vessels are screened.
struct ScreeningPlan {
  screening::Criterion criterion;
  std::size_t top = 0;                       ///< vessels to list; 0: nothing is screened
  std::vector<std::uint32_t> left_out = {};  ///< numbers of a graph's vessels that are not screened
};

struct SolvedNetwork {
  hemodynamics::NetworkSolution solution;
  std::optional<screening::ScreenedNetwork> screened;

  const hemodynamics::NetworkFlow& flow() const { return solution.flow; }
};

/// `solver` has been prepared. Collective. Throws RunError.
SolvedNetwork solve_network(hemodynamics::FlowSolver& solver, const hemodynamics::FlowProblem& problem,
                            const ScreeningPlan& plan, const hemodynamics::Progress& progress,
                            parallel::Communicator comm);

}  // namespace rhexis::studies
