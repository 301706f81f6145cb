// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/sample.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"
#include "peridynamics/stability/time_steps.hpp"

namespace rhexis::ensemble {

std::optional<Sample> simulate(const Parameters& p, const peridynamics::Parameters& v, double pressure,
                               std::int64_t wall, const std::function<bool()>& stop,
                               std::int64_t& bond_evaluations) {
  Sample sample;
  sample.pressure = pressure;
  sample.wall = wall;
  sample.factors = draw_wall(p, wall);
  peridynamics::Parameters vessel = with_wall(v, sample.factors);
  vessel.pressure = pressure;
  vessel.scatter.seed += wall;

  const peridynamics::Lattice lattice = peridynamics::make_lattice(vessel);
  const peridynamics::SharedFamilies families = peridynamics::shared_families(vessel, lattice);
  const peridynamics::TimeSteps time = peridynamics::time_steps(vessel, lattice, families);
  peridynamics::VesselSimulation simulation(vessel, families, time.step, parallel::Communicator::self());
  const auto refuse = [&](long step) {
    throw RunError(fmt::format(
        "wall {} under {} (strength x {}, thickness x {}, stiffness x {}) became unstable by {}; use a "
        "smaller time.step_fraction (now {}), in another folder: samples of both steps do not mix",
        wall, mmhg(pressure), text(sample.factors.strength), text(sample.factors.thickness),
        text(sample.factors.stiffness), quantity(simulation.time_at(step), "s"), text(vessel.step_fraction)));
  };
  peridynamics::LoadSource load;
  peridynamics::Body& body = simulation.body();
  while (simulation.step_number() < time.count && !simulation.rupture().onset) {
    if (stop()) return {};
    if (simulation.step(load).unstable) refuse(simulation.step_number() + 1);
  }
  body.observe(simulation.pressure());
  const peridynamics::Totals last = body.totals();
  if (!peridynamics::holds_no_more_than_was_put_in(last)) refuse(simulation.step_number());
  simulation.conclude(last);
  sample.steps = simulation.step_number();
  sample.first_break = simulation.rupture().first_break;
  sample.onset = simulation.rupture().onset;
  sample.ruptured = sample.onset.has_value();
  sample.max_displacement = body.max_displacement();
  bond_evaluations += body.bond_evaluations();
  return sample;
}

}  // namespace rhexis::ensemble
