#include "hemodynamics/conjugate_gradients.hpp"

#include <algorithm>

#include "hemodynamics/vector_operations.hpp"

namespace rhexis::hemodynamics {

ConjugateGradients::ConjugateGradients(const CoreSystem& system, Preconditioner& preconditioner, int threads)
    : system_(system),
      preconditioner_(preconditioner),
      threads_(threads),
      direction_(system.junctions()),
      image_(system.unknowns()),
      preconditioned_(system.unknowns()) {}

std::int64_t ConjugateGradients::solve(std::span<double> residual, std::span<double> solution,
                                       const StopRule& stop) {
  const std::size_t unknowns = system_.unknowns();
  const std::span<double> x = solution.first(unknowns), p = std::span(direction_).first(unknowns);
  std::fill(solution.begin(), solution.end(), 0.0);
  std::fill(direction_.begin(), direction_.end(), 0.0);
  double old_product = 1;
  for (std::int64_t n = 0; n < stop.max_iterations; ++n) {
    const double worst = largest(residual);
    if (worst <= std::max(stop.least, stop.imbalance * system_.inflow(solution))) return n;
    preconditioner_.apply(residual, preconditioned_);
    const double product = dot(residual, preconditioned_, threads_);
    if (!(product > 0)) return n;
    scale_and_add(preconditioned_, product / old_product, p, threads_);
    old_product = product;
    system_.apply(direction_, image_, threads_);
    const double curvature = dot(p, image_, threads_);
    if (!(curvature > 0)) return n;
    const double step = product / curvature;
    add_scaled(step, p, x, threads_);
    add_scaled(-step, image_, residual, threads_);
  }
  return stop.max_iterations;
}

}  // namespace rhexis::hemodynamics
