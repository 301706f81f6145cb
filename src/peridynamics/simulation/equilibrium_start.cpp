// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/simulation/equilibrium_start.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::peridynamics {

Equilibrium start_at_equilibrium(VesselSimulation& simulation, const WallModel& wall,
                                 parallel::Communicator comm) {
  const Parameters& v = wall.parameters;
  Body& body = simulation.body();
  Equilibrium found = find_equilibrium(wall, v.equilibrium_pressure, v.equilibrium_tolerance, comm);

  std::array<std::vector<double>, 3> at_rest;
  for (std::vector<double>& component : at_rest) component.assign(found.displacement[0].size(), 0.0);
  body.set_state(found.displacement, at_rest);
  Body::Saved state = body.save();
  state.external_work = {found.strain_energy, 0};
  // What the stored energy can give a loose particle.
  state.load_speed = std::sqrt(2 * found.largest_energy_density / v.density);
  body.restore(state);

  body.observe(v.equilibrium_pressure);
  if (const std::int64_t broken = body.totals().broken_bonds; broken > 0) {
    throw RunError(fmt::format(
        "the wall does not bear start.equilibrium_pressure = {}: {} bonds are stretched beyond {} in the "
        "equilibrium; start from a lower pressure",
        quantity(v.equilibrium_pressure, "Pa"), grouped(broken), text(*v.critical_stretch)));
  }
  return found;
}

}  // namespace rhexis::peridynamics
