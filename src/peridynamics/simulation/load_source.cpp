// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/simulation/load_source.hpp"

#include <algorithm>

#include "peridynamics/loads/venting.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"

namespace rhexis::peridynamics {
namespace {

/// Steps between measurements of the opening.
constexpr long venting_interval = 10;

}  // namespace

double LoadSource::leak(const VesselSimulation& simulation) const {
  const Parameters& p = simulation.parameters();
  return orifice_flow(p.discharge_coefficient, simulation.load().open_area, simulation.pressure(),
                      p.blood_density);
}

void VentedLoad::before_step(VesselSimulation& simulation) {
  if (!simulation.rupture().onset || simulation.step_number() % venting_interval != 0) return;
  LoadState& load = simulation.load();
  load.open_area = simulation.gauge().open_area();
  load.next_share = venting_factor(load.open_area, supply_area_);
  load.least_share = std::min(load.least_share, load.next_share);
}

}  // namespace rhexis::peridynamics
