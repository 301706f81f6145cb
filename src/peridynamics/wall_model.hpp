// SPDX-License-Identifier: BSD-3-Clause
/// A wall as resolved parameters make it: particles, families of bonds, load, strength, ends and time steps.
/// It is built once and then only read: by `rhexis check`, by the search for an equilibrium, by the run, and
/// by a sample of an ensemble.
#pragma once

#include <memory>

#include "peridynamics/engine/body.hpp"
#include "peridynamics/parameters.hpp"
#include "peridynamics/stability/time_steps.hpp"

namespace rhexis::peridynamics {

struct WallModel {
  Parameters parameters;  ///< resolved
  BodySetup setup;        ///< with the time step to take
  TimeSteps time;

  const Lattice& lattice() const { return setup.lattice; }
  const BondFamilies& families() const { return *setup.families; }
  bool is_periodic() const { return setup.ends == EndCondition::axial_periodic; }
  /// Particles, without those that thin spots leave out.
  std::int64_t particles() const { return setup.lattice.particles() - setup.thin_spots.absent(); }
};

/// Models are large and are never changed, so they are shared.
using SharedWall = std::shared_ptr<const WallModel>;

/// `families`: of a wall of the same geometry, where there is one; else they are found. Throws InputError,
/// with the key at fault, where no particle is loaded or none is free, and for a time step that is unstable
/// or far too short.
SharedWall make_wall(Parameters resolved, SharedFamilies families = nullptr);

}  // namespace rhexis::peridynamics
