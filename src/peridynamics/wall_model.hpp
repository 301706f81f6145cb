// SPDX-License-Identifier: BSD-3-Clause
/// A wall as resolved parameters make it: particles, families of bonds, load, strength, ends and time steps.
/// It is built once and then only read: by `rhexis check`, by the search for an equilibrium, by the run, and
/// by a sample of an ensemble.
#pragma once

#include <memory>

#include "peridynamics/engine/body.hpp"
#include "peridynamics/parameters.hpp"
#include "peridynamics/stability/time_steps.hpp"
#include "peridynamics/tube_setup.hpp"

namespace rhexis::peridynamics {

struct WallModel {
  Parameters parameters;  ///< resolved
  BodySetup setup;        ///< with the time step to take; of a law by gradient without families and load
  GeneralTube general;    ///< of a law by gradient; else empty
  TimeSteps time;

  const Lattice& lattice() const { return setup.lattice; }
  const BondFamilies& families() const { return *setup.families; }
  bool by_gradient() const { return general.setup != nullptr; }
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

/// Undirected bonds of a wall, and the most bonds that a particle has.
struct BondCount {
  std::int64_t total = 0, largest_family = 0;
};
BondCount count_bonds(const WallModel& wall);

/// Arithmetic of one evaluation of a bond, as Body::bond_evaluations counts them.
double flop_per_evaluation(const WallModel& wall);

/// A piece of `rows` rows of the wall with free ends, to be timed. Collective.
std::unique_ptr<Body> make_piece(const WallModel& wall, std::int64_t rows, parallel::Communicator comm);

/// The wall at rest, in motion from time 0 on. Collective.
std::unique_ptr<Body> make_body(const WallModel& wall, parallel::Communicator comm);

}  // namespace rhexis::peridynamics
