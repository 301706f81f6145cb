// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/conjugate_gradients.hpp"

#include <algorithm>

#include "hemodynamics/steady/graph/vector_operations.hpp"

namespace rhexis::hemodynamics {

ConjugateGradients::ConjugateGradients(const CoreSystem& system, Preconditioner& preconditioner, int threads)
    : system_(system),
      preconditioner_(preconditioner),
      threads_(threads),
      direction_(system.junctions()),
      image_(system.junctions()),
      preconditioned_(system.junctions()) {}

std::int64_t ConjugateGradients::solve(std::span<double> residual, std::span<double> solution,
                                       const StopRule& stop) {
  const auto own = [&](std::span<double> vector) { return vector.first(system_.owned()); };
  std::fill(solution.begin(), solution.end(), 0.0);
  std::fill(direction_.begin(), direction_.end(), 0.0);
  double old_product = 1;
  for (std::int64_t n = 0; n < stop.max_iterations; ++n) {
    const double worst = system_.largest(residual);
    if (worst <= std::max(stop.least, stop.imbalance * system_.inflow(solution))) return n;
    preconditioner_.apply(own(residual), own(preconditioned_));
    const double product = system_.dot(residual, preconditioned_, threads_);
    if (!(product > 0)) return n;
    scale_and_add(own(preconditioned_), product / old_product, own(direction_), threads_);
    old_product = product;
    system_.apply(direction_, image_, threads_);
    const double curvature = system_.dot(direction_, image_, threads_);
    if (!(curvature > 0)) return n;
    const double step = product / curvature;
    add_scaled(step, direction_, solution, threads_);
    add_scaled(-step, own(image_), own(residual), threads_);
  }
  return stop.max_iterations;
}

}  // namespace rhexis::hemodynamics
