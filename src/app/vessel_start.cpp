// SPDX-License-Identifier: BSD-3-Clause
// The quasi-static start of a vessel's run.
#include <fmt/format.h>

#include <cmath>

#include "app/vessel_run.hpp"
#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "peridynamics/statics/equilibrium.hpp"

namespace rhexis::app {

/// Brings the wall to rest under start.equilibrium_pressure, as if the schedule had risen to it infinitely
/// slowly: the work done so far is the strain energy. Throws RunError where the wall does not bear it.
void VesselRun::start_at_equilibrium() {
  const peridynamics::Parameters& v = c_.vessel;
  const Stopwatch watch(session_.spent().solve);
  peridynamics::Equilibrium found =
      peridynamics::find_equilibrium(peridynamics::make_setup(v, lattice_, c_.families, c_.time_step),
                                     v.equilibrium_pressure, v.equilibrium_tolerance, comm_);
  start_bond_evaluations_ = found.bond_evaluations;

  std::array<std::vector<double>, 3> at_rest;
  for (std::vector<double>& component : at_rest) component.assign(found.displacement[0].size(), 0.0);
  body_->set_state(found.displacement, at_rest);
  peridynamics::Body::Saved state = body_->save();
  state.external_work = {found.strain_energy, 0};
  // What the stored energy can give a loose particle.
  state.load_speed = std::sqrt(2 * found.largest_energy_density / v.density);
  body_->restore(state);

  body_->observe(v.equilibrium_pressure);
  if (const std::int64_t broken = body_->totals().broken_bonds; broken > 0) {
    throw RunError(fmt::format(
        "the wall does not bear start.equilibrium_pressure = {}: {} bonds are stretched beyond {} in the "
        "equilibrium; start from a lower pressure",
        quantity(v.equilibrium_pressure, "Pa"), grouped(broken), text(*v.critical_stretch)));
  }
  session_.console().item("start",
                          fmt::format("equilibrium under {}: {} steps of relaxation, residual {:.1e}, strain "
                                      "energy {}",
                                      quantity(v.equilibrium_pressure, "Pa"), found.steps, found.residual,
                                      quantity(found.strain_energy, "J")));
}

}  // namespace rhexis::app
