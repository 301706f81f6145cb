// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/sample.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/loads/schedule.hpp"
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
  const auto body = peridynamics::make_body(peridynamics::make_setup(vessel, lattice, families, time.step),
                                            parallel::Communicator::self());
  const auto time_at = [&](long step) { return static_cast<double>(step) * time.step; };
  const auto pressure_at = [&](long step) { return peridynamics::scheduled_pressure(vessel, time_at(step)); };
  const auto refuse = [&] {
    throw RunError(fmt::format(
        "wall {} under {} (strength x {}, thickness x {}, stiffness x {}) became unstable by {}; use a "
        "smaller time.step_fraction (now {}), in another folder: samples of both steps do not mix",
        wall, mmhg(pressure), text(sample.factors.strength), text(sample.factors.thickness),
        text(sample.factors.stiffness), quantity(time_at(sample.steps), "s"), text(vessel.step_fraction)));
  };
  while (sample.steps < time.count && !sample.ruptured) {
    if (stop()) return {};
    // Events are of the moment before the step.
    const long step = sample.steps++;
    const peridynamics::StepEvents events = body->advance(pressure_at(step), pressure_at(step + 1));
    if (events.unstable) refuse();
    if (events.broken > 0 && !sample.first_break) sample.first_break = time_at(step);
    if (events.damaged) {
      sample.ruptured = true;
      sample.onset = time_at(step);
    }
  }
  body->observe(pressure_at(sample.steps));
  const peridynamics::Totals last = body->totals();
  if (!peridynamics::holds_no_more_than_was_put_in(last)) refuse();
  if (last.broken_bonds > 0 && !sample.first_break) sample.first_break = time_at(sample.steps);
  if (last.max_damage >= peridynamics::rupture_damage && !sample.ruptured) {
    sample.ruptured = true;
    sample.onset = time_at(sample.steps);
  }
  sample.max_displacement = body->max_displacement();
  bond_evaluations += body->bond_evaluations();
  return sample;
}

}  // namespace rhexis::ensemble
