// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ensemble/sample.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/simulation/energy_balance.hpp"
#include "peridynamics/simulation/time_loop.hpp"

namespace rhexis::ensemble {

std::optional<Sample> simulate(const Parameters& p, const peridynamics::WallModel& mean, double pressure,
                               std::int64_t wall, const std::function<int()>& signal,
                               std::int64_t& bond_evaluations) {
  Sample sample;
  sample.pressure = pressure;
  sample.wall = wall;
  sample.factors = draw_wall(p, wall);
  peridynamics::Parameters drawn = with_wall(mean.parameters, sample.factors);
  drawn.pressure = pressure;
  drawn.scatter.seed += wall;

  // Families are of the geometry alone.
  const bool same_geometry = sample.factors.thickness == 1;
  const peridynamics::SharedWall model =
      peridynamics::make_wall(std::move(drawn), same_geometry ? mean.setup.families : nullptr);
  peridynamics::VesselSimulation simulation(*model, parallel::Communicator::self());
  peridynamics::LoadSource load;
  peridynamics::EnergyBalance balance(simulation, {});
  peridynamics::TimeLoop loop(simulation, load,
                              {.steps = model->time.count, .ends_at_rupture = true, .signal = signal});
  loop.subscribe(balance);
  try {
    if (loop.run() != 0) return {};
  } catch (const peridynamics::UnstableError& error) {
    throw RunError(fmt::format(
        "wall {} under {} (strength x {}, thickness x {}, stiffness x {}) became unstable by {}; use a "
        "smaller time.step_fraction (now {}), in another folder: samples of both steps do not mix",
        wall, mmhg(pressure), text(sample.factors.strength), text(sample.factors.thickness),
        text(sample.factors.stiffness), quantity(simulation.time_at(error.step), "s"),
        text(model->parameters.step_fraction)));
  }
  sample.steps = simulation.step_number();
  sample.first_break = simulation.rupture().first_break;
  sample.onset = simulation.rupture().onset;
  sample.ruptured = sample.onset.has_value();
  sample.max_displacement = simulation.body().max_displacement();
  bond_evaluations += simulation.body().bond_evaluations();
  return sample;
}

}  // namespace rhexis::ensemble
