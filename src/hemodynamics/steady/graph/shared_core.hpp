// SPDX-License-Identifier: BSD-3-Clause
/// What is left of all ranks' parts, solved where it is: conjugate gradients over the ranks, preconditioned
/// by BoomerAMG.
#pragma once

#include <cstdint>
#include <vector>

#include "hemodynamics/steady/graph/gathered_core.hpp"
#include "parallel/shared_values.hpp"

namespace rhexis::hemodynamics {

/// Collective. `links` in indices of `part.junctions`; `inflow_by_conditions` is this rank's.
CorePartSolution solve_shared(const CorePart& part, const std::vector<parallel::SharedLink>& links,
                              double inflow_by_conditions, const GraphSolverOptions& options,
                              parallel::Communicator comm);

}  // namespace rhexis::hemodynamics
