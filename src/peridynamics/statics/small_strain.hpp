// SPDX-License-Identifier: BSD-3-Clause
/// What a small pressure does to a body of any kind, where forces are linear in displacements.
#pragma once

#include <array>
#include <vector>

#include "parallel/communicator.hpp"
#include "peridynamics/engine/body.hpp"

namespace rhexis::peridynamics {

struct SmallStrain {
  std::array<std::vector<double>, 3> displacement;  ///< m for a pressure of 1 Pa, of owned particles
  int iterations = 0;
};

/// Conjugate gradients on the forces of `body`, which is left displaced; `scale`: displacements (m) for which
/// its law is linear to the digits that count. Held components stay 0; of a body that nothing holds the
/// answer is free of rigid motions as far as its load is. Stops once the residual has fallen by `tolerance`.
/// Throws RunError where it does not. Collective.
SmallStrain find_small_strain(Body& body, double scale, double tolerance, parallel::Communicator comm);

}  // namespace rhexis::peridynamics
