// SPDX-License-Identifier: BSD-3-Clause
/// Preconditioned conjugate gradients (Hestenes & Stiefel 1952) for A x = r over the unknowns of a
/// CoreSystem, stopped on what a user of flows can judge: the worst junction's imbalance against the inflow.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hemodynamics/steady/graph/core_system.hpp"
#include "hemodynamics/steady/graph/preconditioner.hpp"

namespace rhexis::hemodynamics {

/// When to stop: the largest residual is at most `imbalance` times the inflow of pressures p + x, or `least`,
/// m3/s, below which the system cannot tell it from zero.
struct StopRule {
  double imbalance = 0;
  double least = 0;
  std::int64_t max_iterations = 0;
};

class ConjugateGradients {
 public:
  ConjugateGradients(const CoreSystem& system, Preconditioner& preconditioner, int threads);

  /// From zero; `residual` becomes that of `solution`; both are [junctions]. Returns the number of
  /// iterations. It may end early where rounding has taken all that a search direction held: the caller
  /// judges by the residual of the pressures themselves.
  std::int64_t solve(std::span<double> residual, std::span<double> solution, const StopRule& stop);

 private:
  const CoreSystem& system_;
  Preconditioner& preconditioner_;
  int threads_;
  std::vector<double> direction_, image_, preconditioned_;
};

}  // namespace rhexis::hemodynamics
