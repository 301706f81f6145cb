/// Iterative refinement (Wilkinson 1963) around conjugate gradients: the imbalance of the pressures, which
/// are carried in two doubles, is the right-hand side of the next correction. What ends it is the imbalance
/// of the flows that are returned.
#pragma once

#include <cstdint>

#include "hemodynamics/core_system.hpp"
#include "hemodynamics/graph_flow.hpp"

namespace rhexis::hemodynamics {

/// Unknowns up to which a complete factor is cheaper than an approximate one.
inline constexpr std::size_t largest_for_ldlt = 1000;

/// Solves for the pressures of `system` by `solver` (one of the four of preconditioner.hpp); returns
/// iterations. Throws RunError, saying what was reached, where the imbalance asked for is not.
std::int64_t solve_core(CoreSystem& system, GraphSolver solver, const GraphSolverOptions& options);

}  // namespace rhexis::hemodynamics
