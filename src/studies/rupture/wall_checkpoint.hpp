// SPDX-License-Identifier: BSD-3-Clause
/// What a checkpoint holds of a wall in time, to go on from bit by bit on any number of ranks.
#pragma once

#include "output/checkpoint.hpp"
#include "peridynamics/simulation/load_source.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"

namespace rhexis::studies {

/// Warnings that a simulation gives once, also where it is continued.
struct GivenWarnings {
  bool crushed_bonds = false;  ///< peridynamics/simulation/energy_balance.hpp
  bool turbulence = false;     ///< coupling/turbulence_observer.hpp
};

/// Collective. Throws RunError.
void save_wall(const peridynamics::VesselSimulation& simulation, const GivenWarnings& given,
               output::CheckpointWriter& file);

/// Brings a simulation of the same wall to `step`, of which the checkpoint is. `load`: what will load it.
/// Collective. Throws InputError.
void restore_wall(peridynamics::VesselSimulation& simulation, const peridynamics::LoadSource& load,
                  GivenWarnings& given, long step, output::CheckpointReader& file);

}  // namespace rhexis::studies
