// SPDX-License-Identifier: BSD-3-Clause
#include "studies/flow/solved_network.hpp"

namespace rhexis::studies {

SolvedNetwork solve_network(hemodynamics::FlowSolver& solver, const hemodynamics::FlowProblem& problem,
                            const ScreeningPlan& plan, const hemodynamics::Progress& progress,
                            parallel::Communicator comm) {
  if (plan.top == 0) return {solver.solve(progress, nullptr), {}};
  screening::NetworkScreening screening(problem, plan.criterion, plan.top, plan.left_out);
  SolvedNetwork network{solver.solve(progress, &screening), {}};
  network.screened = screening.result(solver, comm);
  return network;
}

}  // namespace rhexis::studies
