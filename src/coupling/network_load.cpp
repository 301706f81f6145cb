// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/network_load.hpp"

#include "peridynamics/loads/schedule.hpp"

namespace rhexis::coupling {

/// Takes over what the network says of the load: of its size from the next step on, as with venting, so that
/// the work done stays exact.
void NetworkLoad::start(peridynamics::VesselSimulation& simulation) {
  const double full = simulation.parameters().pressure;
  if (full > 0) simulation.load().next_share = vessel_->pressure() / full;
  simulation.body().set_axial_profile(vessel_->profile());
}

/// From the onset of rupture the lumen counts as it was then: fragments are no wall.
void NetworkLoad::at_moment(peridynamics::VesselSimulation& simulation) {
  if (!vessel_->due(simulation.step_number())) return;
  peridynamics::LoadState& load = simulation.load();
  if (simulation.rupture().onset) {
    load.open_area = simulation.gauge().open_area();
  } else {
    load.resistance_factor = simulation.gauge().resistance_factor();
  }
  const double time = simulation.time();
  vessel_->exchange({.time_s = time,
                     .schedule = peridynamics::schedule_share(simulation.parameters(), time),
                     .opening = load.open_area,
                     .resistance_factor = load.resistance_factor});
  start(simulation);
}

}  // namespace rhexis::coupling
