// SPDX-License-Identifier: BSD-3-Clause
#include "app/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "parallel/together.hpp"
#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/laws/strength.hpp"
#include "peridynamics/loads/schedule.hpp"
#include "peridynamics/stability/linear_limit.hpp"
#include "peridynamics/statics/elastic_error.hpp"
#include "peridynamics/wall_memory.hpp"
#include "runtime/console.hpp"
#include "scenes/coupled/network_coupling.hpp"
#include "scenes/vessel/vessel_run.hpp"

namespace rhexis::app {
namespace {

/// Seconds one step of the whole body takes on these ranks, from a few steps of a short piece of it.
double seconds_per_step(const peridynamics::WallModel& wall, parallel::Communicator comm) {
  constexpr int timed_steps = 10;
  const std::int64_t rows =
      std::min<std::int64_t>(wall.lattice().rows, peridynamics::timed_rows * comm.size());
  const double share = static_cast<double>(rows) / static_cast<double>(wall.lattice().rows);
  const auto body = peridynamics::make_piece(wall, rows, comm);
  body->advance(0, 0);  // warms caches and pages
  const double start = seconds_now();
  for (int i = 0; i < timed_steps; ++i) body->advance(0, 0);
  const double elapsed = seconds_now() - start;
  return comm.all_reduce(elapsed, parallel::Reduce::max) / timed_steps / share;
}

runtime::Console console_of(const scenes::Reading& reading) {
  return {reading.comm.is_root(), false};
}

void print_validity(runtime::Console& console, const scenes::SceneInput& s) {
  console.line(s.file + " is valid.");
  for (const std::string& warning : s.warnings) console.warning(warning);
}

void print_particles(runtime::Console& console, const peridynamics::WallModel& wall) {
  const peridynamics::Lattice& lattice = wall.lattice();
  console.item("spacing", quantity(lattice.spacing, "m") +
                              fmt::format(" ({:.1f} across the wall), {} between rows",
                                          (wall.parameters.outer_radius - wall.parameters.inner_radius) /
                                              lattice.spacing,
                                          quantity(lattice.row_spacing, "m")));
  console.item("horizon", quantity(lattice.horizon, "m") +
                              fmt::format(" ({:.4g} spacings)", lattice.horizon / lattice.spacing));
  const std::int64_t absent = wall.setup.thin_spots.absent();
  console.item(
      "particles",
      fmt::format("{} = {} columns x {} rows{}", grouped(wall.particles()), lattice.section.size(),
                  lattice.rows,
                  absent > 0 ? fmt::format(" less the {} that thin spots leave out", grouped(absent)) : ""));
  const peridynamics::BondCount bonds = peridynamics::count_bonds(wall);
  console.item("bonds", fmt::format("{}{}, at most {} a particle", absent > 0 ? "fewer than " : "",
                                    grouped(bonds.total), bonds.largest_family));
}

void print_accuracy(runtime::Console& console, const peridynamics::WallModel& wall,
                    parallel::Communicator comm) {
  // On one rank: on each it would take memory of its own.
  std::optional<peridynamics::ElasticError> error;
  parallel::on_root<RunError>(comm, [&] { error = peridynamics::elastic_error(wall); });
  const std::string found =
      error ? fmt::format("{:.2g} % off Lame's static expansion, evenly over the wall to {:.2g} %",
                          100 * error->relative_l2, 100 * error->spread)
            : "not estimated: a wall so thin, of so many columns, takes too long to solve";
  console.item("accuracy", wall.by_gradient()
                               ? found
                               : fmt::format("{} (surface correction {}, layer {})", found,
                                             name_of(peridynamics::surface_correction(wall.parameters)),
                                             name_of(wall.parameters.layer)));
  console.item("strength", peridynamics::describe_strength(wall.parameters));
}

void print_time_step(runtime::Console& console, const peridynamics::WallModel& wall,
                     parallel::Communicator comm) {
  double limit = 0;
  parallel::on_root<RunError>(comm, [&] { limit = peridynamics::linear_time_step_limit(wall); });
  console.item("time step",
               fmt::format("{} ({:.0f} % of the stable {}), {} steps", quantity(wall.time.step, "s"),
                           100 * wall.time.step / wall.time.stable, quantity(wall.time.stable, "s"),
                           grouped(wall.time.count)));
  console.item("instability",
               fmt::format("begins at {} where strains are small, {:.2f} times the stable step",
                           quantity(limit, "s"), limit / wall.time.stable));
}

/// "4 ranks x 2 threads".
std::string processors(parallel::Communicator comm) {
  return fmt::format("{} rank{} x {} thread{}", comm.size(), comm.size() > 1 ? "s" : "",
                     parallel::thread_count(), parallel::thread_count() > 1 ? "s" : "");
}

/// What a run of `s.wall`, on all ranks together, will take; `step`: s, of one time step.
void print_time(runtime::Console& console, const scenes::VesselScene& s, double step,
                parallel::Communicator comm) {
  console.item("outputs", grouped(static_cast<long long>(s.output_steps.size())));
  console.item("time",
               fmt::format("about {} of solving on {} (measured now; output and pictures come on top)",
                           duration(step * static_cast<double>(s.wall->time.count)), processors(comm)));
}

}  // namespace

void check(const scenes::VesselScene& s, const scenes::Reading& reading) {
  const peridynamics::WallModel& wall = *s.wall;
  const double step = seconds_per_step(wall, reading.comm);
  runtime::Console console = console_of(reading);
  print_validity(console, s);
  print_particles(console, wall);
  print_accuracy(console, wall, reading.comm);
  console.item("load",
               fmt::format("{} ({}) {}", quantity(peridynamics::highest_pressure(wall.parameters), "Pa"),
                           peridynamics::describe_schedule(wall.parameters),
                           peridynamics::describe_direction(wall.parameters)));
  scenes::print_risk(console, wall.parameters);
  print_time_step(console, wall, reading.comm);
  print_time(console, s, step, reading.comm);
}

void check(const scenes::CoupledScene& s, const scenes::Reading& reading) {
  // The wall is known when the network has been solved.
  scenes::CoupledScene solved = s;
  solved.network.problem.network.statistics = false;
  runtime::Console console = console_of(reading);
  console.line("Solving the network, which says what the wall and its load are:");
  scenes::NetworkCoupling coupling(solved, nullptr, reading, console);
  if (coupling.at_rest()) {
    console.line(
        fmt::format("{} is valid. No vessel's risk is above cascade.risk_limit = {}: no wall is simulated.",
                    s.file, text(s.coupling.risk_limit)));
    return;
  }
  const scenes::VesselScene vessel = coupling.make_vessel();
  const peridynamics::WallModel& wall = *vessel.wall;
  const double step = seconds_per_step(wall, reading.comm);
  print_validity(console, vessel);
  coupling.print_header(console, wall.time.step);
  print_particles(console, wall);
  print_accuracy(console, wall, reading.comm);
  print_time_step(console, wall, reading.comm);
  print_time(console, vessel, step, reading.comm);
}

void check(const scenes::EnsembleScene& s, const scenes::Reading& reading) {
  const peridynamics::WallModel& wall = *s.wall;
  const parallel::Communicator comm = reading.comm;
  // A sample belongs to one rank, while the others have theirs.
  const double step =
      comm.all_reduce(seconds_per_step(wall, parallel::Communicator::self()), parallel::Reduce::max);
  runtime::Console console = console_of(reading);
  print_validity(console, s);
  print_particles(console, wall);
  print_accuracy(console, wall, comm);
  print_time_step(console, wall, comm);
  const ensemble::Parameters& e = s.ensemble;
  console.item("pressures", fmt::format("{} from {} to {}", e.pressures.size(), mmhg(e.pressures.front()),
                                        mmhg(e.pressures.back())));
  console.item("samples", fmt::format("{} = {} walls x {} pressures; the numbers above are of the mean wall",
                                      grouped(e.vessels()), e.samples, e.pressures.size()));
  const double sample = step * static_cast<double>(wall.time.count);
  const auto rounds = (e.vessels() + comm.size() - 1) / comm.size();
  console.item("time", fmt::format("at most about {} ({} a sample that lasts to the end; those that rupture "
                                   "stop there) on {} (measured now)",
                                   duration(sample * static_cast<double>(rounds)), duration(sample),
                                   processors(comm)));
}

}  // namespace rhexis::app
