// SPDX-License-Identifier: BSD-3-Clause
/// How far a discretisation is from linear elasticity, found without simulating anything.
#pragma once

#include <optional>

#include "peridynamics/wall_model.hpp"

namespace rhexis::peridynamics {

/// Lame's radial displacement of a tube under inner pressure in plane strain, m; r in m, Pa:
/// u_r = (1 + nu)/E P r0^2 / (r1^2 - r0^2) ((1 - 2 nu) r + r1^2 / r).
double lame_displacement(const Parameters& p, double pressure, double r);

/// Static, infinitesimal expansion of an endless vessel against Lame's solution.
struct ElasticError {
  double relative_l2 = 0;  ///< relative L2 error of the radial displacement over the wall
  double spread = 0;       ///< largest / smallest ratio to Lame's solution, less 1
};

/// Multiplications that `elastic_error` may take where the user did not ask for it: some ten seconds of a
/// processor.
inline constexpr double bounded_work = 1e10;

/// Solves the linearised bonds of one cross-section, displacements independent of z, for the load of
/// `setup.layer`, by conjugate gradients. Nothing where these take more than `most_multiplications`, as those
/// of a very thin wall of very many columns do, which bends easily. Throws RunError where the bonds do not
/// hold the wall together.
std::optional<ElasticError> elastic_error(const Parameters& p, const BodySetup& setup,
                                          double most_multiplications = bounded_work);

/// The same of a wall of any law; of one by gradient in a short piece of the tube, from its forces.
std::optional<ElasticError> elastic_error(const WallModel& wall, double most_multiplications = bounded_work);

/// Memory that finding it takes.
double elastic_error_bytes(const Parameters& p, const WallSize& size);

}  // namespace rhexis::peridynamics
