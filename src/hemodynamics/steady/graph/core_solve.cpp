// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/core_solve.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/format.hpp"
#include "hemodynamics/steady/graph/conjugate_gradients.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::hemodynamics {
namespace {

// Fewer unknowns than this are not worth waking threads for: most of an iteration is the preconditioner,
// which is of one thread, and on a busy machine waiting for the other threads costs several times what they
// save.
constexpr std::size_t serial_unknowns = 400000;

// One round of conjugate gradients is not asked for more than doubles can give.
constexpr double reduction_per_round = 1e-10;

// Rounds in a row that bring less than a factor of two before it is said that nothing more is gained.
constexpr int idle_rounds = 6;

[[noreturn]] void fail(GraphSolver solver, const GraphSolverOptions& options, std::int64_t iterations,
                       double reached) {
  const std::string name(name_of(solver));
  const bool out_of_iterations = iterations >= options.max_iterations;
  throw RunError(
      "solver '" + name + "' reached an imbalance of " + text(reached) + " of the inflow in " +
      std::to_string(iterations) + " iterations, not the " + text(options.imbalance) +
      " asked for: " + (solver == GraphSolver::approximate_cholesky ? "" : "use 'approximate_cholesky', ") +
      (out_of_iterations ? "allow more iterations or a larger imbalance" : "allow a larger imbalance"));
}

}  // namespace

GraphSolver choose_solver(const GraphSolverOptions& options, std::size_t unknowns) {
  if (unknowns == 0) return GraphSolver::elimination;
  if (options.solver == GraphSolver::elimination) {
    throw InputError(
        "solver 'elimination' leaves " + std::to_string(unknowns) +
        " junctions of this network, which has loops, or more than two places where a pressure is given: "
        "use 'auto'");
  }
  if (options.solver != GraphSolver::automatic) return options.solver;
  return unknowns <= largest_for_ldlt ? GraphSolver::ldlt : GraphSolver::approximate_cholesky;
}

std::int64_t solve_core(CoreSystem& system, Preconditioner& preconditioner, GraphSolver solver,
                        const GraphSolverOptions& options) {
  const int threads = system.unknowns() < serial_unknowns ? 1 : parallel::thread_count();
  ConjugateGradients gradients(system, preconditioner, threads);
  std::vector<double> residual(system.junctions()), correction(system.junctions());
  std::int64_t iterations = 0;
  double best = INFINITY;
  for (int idle = 0;;) {
    std::fill(correction.begin(), correction.end(), 0.0);
    system.imbalance(residual, threads);
    const double worst = system.largest(residual), inflow = system.inflow(correction);
    const double resolution = system.resolution();
    if (worst <= std::max(options.imbalance * inflow, resolution)) return iterations;
    idle = worst < 0.5 * best ? 0 : idle + 1;
    best = std::min(best, worst);
    if (idle > idle_rounds || iterations >= options.max_iterations || !std::isfinite(worst)) {
      fail(solver, options, iterations, worst / inflow);
    }
    // Half of what is asked for, as the residual that is carried along drifts from the true one.
    const StopRule stop{.imbalance = 0.5 * options.imbalance,
                        .least = std::max(resolution, reduction_per_round * worst),
                        .max_iterations = options.max_iterations - iterations};
    iterations += gradients.solve(residual, correction, stop);
    system.add(correction);
  }
}

}  // namespace rhexis::hemodynamics
