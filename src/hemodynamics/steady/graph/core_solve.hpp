// SPDX-License-Identifier: BSD-3-Clause
/// Iterative refinement (Wilkinson 1963) around conjugate gradients: the imbalance of the pressures, which
/// are carried in two doubles, is the right-hand side of the next correction. What ends it is the imbalance
/// of the flows that are returned.
#pragma once

#include <cstdint>

#include "hemodynamics/steady/graph/core_system.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "hemodynamics/steady/graph/preconditioner.hpp"

namespace rhexis::hemodynamics {

/// Unknowns up to which a complete factor is used: on lattices in three dimensions it takes no longer than
/// the approximate one up to 5000 and leaves a hundredth of the error; denser networks fill sooner.
inline constexpr std::size_t largest_for_ldlt = 2000;

/// Solves for the pressures of `system` with conjugate gradients preconditioned by `preconditioner`; returns
/// iterations. Throws RunError, saying what was reached, where the imbalance asked for is not. Collective
/// where the system is shared.
std::int64_t solve_core(CoreSystem& system, Preconditioner& preconditioner, GraphSolver solver,
                        const GraphSolverOptions& options);

/// The solver that is used for a core of so many unknowns. Throws InputError where it can be none.
GraphSolver choose_solver(const GraphSolverOptions& options, std::size_t unknowns);

}  // namespace rhexis::hemodynamics
