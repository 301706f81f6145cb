// SPDX-License-Identifier: BSD-3-Clause
/// A quasi-static start: the wall at rest under a pressure, as if the schedule had risen to it infinitely
/// slowly.
#pragma once

#include "peridynamics/simulation/vessel_simulation.hpp"
#include "peridynamics/statics/equilibrium.hpp"

namespace rhexis::peridynamics {

/// Brings the wall to rest under start.equilibrium_pressure; the work done so far is the strain energy.
/// Collective. Throws RunError where the wall does not bear it.
Equilibrium start_at_equilibrium(VesselSimulation& simulation, const WallModel& wall,
                                 parallel::Communicator comm);

}  // namespace rhexis::peridynamics
