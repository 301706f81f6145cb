// SPDX-License-Identifier: BSD-3-Clause
/// Approximate inverses of the Laplacian of a CoreSystem, for conjugate gradients. What a `GraphSolver` names
/// is one of these:
///
///   jacobi                D^-1; costs nothing to make, thousands of iterations at high contrast
///   ldlt                  Eigen's SimplicialLDLT with AMD ordering: exact but for rounding, so one or two
///                         iterations; loops in three dimensions fill it, so for small systems
///   amg                   one V-cycle of hypre's BoomerAMG
///   approximate_cholesky  see approximate_cholesky.hpp
#pragma once

#include <memory>
#include <span>

#include "hemodynamics/steady/graph/core_system.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"

namespace rhexis::hemodynamics {

class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// result = M^-1 residual over the unknowns; symmetric and positive definite.
  virtual void apply(std::span<const double> residual, std::span<double> result) = 0;
};

/// `solver` is one of the four.
std::unique_ptr<Preconditioner> make_preconditioner(const CoreSystem& system, GraphSolver solver);

}  // namespace rhexis::hemodynamics
