// SPDX-License-Identifier: BSD-3-Clause
#include "studies/flow/solved_network.hpp"

#include <fmt/format.h>

namespace rhexis::studies {

SolvedNetwork solve_network(hemodynamics::FlowSolver& solver, const hemodynamics::FlowProblem& problem,
                            const ScreeningPlan& plan, const hemodynamics::Progress& progress,
                            parallel::Communicator comm) {
  if (plan.top == 0) return {solver.solve(progress, nullptr), {}};
  screening::NetworkScreening screening(problem, plan.criterion, plan.top, plan.left_out);
  SolvedNetwork network{solver.solve(progress, &screening), {}};
  network.screened = screening.result(solver, comm);
  if (const auto& survey = network.solution.survey;
      survey && survey->assumed_walls.count > 0 && problem.failures.empty())
    network.solution.warnings.push_back(fmt::format(
        "the risks of {} of {} vessels rest on assumed walls: their thickness is not given, and the "
        "rules of [wall] say it",
        survey->assumed_walls.count, survey->vessels));
  return network;
}

}  // namespace rhexis::studies
