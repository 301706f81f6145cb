// SPDX-License-Identifier: BSD-3-Clause
/// Static equilibrium of the wall under a pressure, by dynamic relaxation: the wall moves under its load, and
/// its velocity is turned towards the forces while they do work, dropped as soon as they do not (FIRE, Bitzek
/// et al. 2006, doi:10.1103/PhysRevLett.97.170201, with a constant step).
///
/// Bonds do not break on the way, for the wall may swing beyond its equilibrium. All sums that decide are
/// exact, so that the answer does not depend on ranks and threads.
#pragma once

#include "peridynamics/wall_model.hpp"

namespace rhexis::peridynamics {

struct Equilibrium {
  std::array<std::vector<double>, 3> displacement;  ///< m, of owned particles
  double strain_energy = 0;                         ///< J; also the work of a pressure that rises slowly
  double largest_energy_density = 0;                ///< J/m3
  double residual = 0;  ///< largest force on a particle that is free to move, relative to the layer's load
  long steps = 0;
  std::int64_t bond_evaluations = 0;  ///< directed, on this rank
};

/// Memory that finding it takes on all ranks beside the run's own body: another one, and displacement,
/// velocity, force and volumes.
inline double equilibrium_bytes(double body_bytes, double particles) {
  return body_bytes + 10 * particles * sizeof(double);
}

/// Finds the equilibrium under `pressure` (Pa) to a residual of at most `tolerance`. Throws RunError where
/// that is not reached in `most_steps`. Collective.
Equilibrium find_equilibrium(const WallModel& wall, double pressure, double tolerance,
                             parallel::Communicator comm, long most_steps = 20000);
/// The same of a tube of columns.
Equilibrium find_equilibrium(BodySetup setup, double pressure, double tolerance, parallel::Communicator comm,
                             long most_steps = 20000);

}  // namespace rhexis::peridynamics
