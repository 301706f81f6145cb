// SPDX-License-Identifier: BSD-3-Clause
#include "app/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/stopwatch.hpp"
#include "parallel/together.hpp"
#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/engine/memory.hpp"
#include "peridynamics/laws/strength.hpp"
#include "peridynamics/loads/schedule.hpp"
#include "peridynamics/stability/linear_limit.hpp"
#include "peridynamics/statics/elastic_error.hpp"
#include "runtime/console.hpp"
#include "scenes/coupled/network_coupling.hpp"
#include "scenes/vessel/vessel_run.hpp"

namespace rhexis::app {
namespace {

/// Seconds one step of the whole body takes on these ranks, from a few steps of a short piece of it.
double seconds_per_step(const peridynamics::WallModel& wall, parallel::Communicator comm) {
  constexpr int timed_steps = 10;
  peridynamics::BodySetup piece = wall.setup;
  piece.lattice.rows = std::min<std::int64_t>(wall.lattice().rows, peridynamics::timed_rows * comm.size());
  piece.ends = peridynamics::EndCondition::free;
  const double share = static_cast<double>(piece.lattice.rows) / static_cast<double>(wall.lattice().rows);
  const auto body = peridynamics::make_body(std::move(piece), comm);
  body->advance(0, 0);  // warms caches and pages
  const double start = seconds_now();
  for (int i = 0; i < timed_steps; ++i) body->advance(0, 0);
  const double elapsed = seconds_now() - start;
  return comm.all_reduce(elapsed, parallel::Reduce::max) / timed_steps / share;
}

/// `say_more`: what else there is to say of the vessel.
void check_wall(const Configuration& c, parallel::Communicator comm,
                const std::function<void(runtime::Console&)>& say_more) {
  const peridynamics::WallModel& wall = *c.wall;
  const peridynamics::Lattice& lattice = wall.lattice();
  // A sample of an ensemble belongs to one rank, while the others have theirs.
  const double step = comm.all_reduce(
      seconds_per_step(wall, c.is_ensemble() ? parallel::Communicator::self() : comm), parallel::Reduce::max);

  runtime::Console console(comm.is_root(), false);
  console.line(c.file + " is valid.");
  for (const std::string& warning : c.warnings) console.warning(warning);
  if (say_more) say_more(console);
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
  console.item("bonds",
               fmt::format("{}{}, at most {} a particle", absent > 0 ? "fewer than " : "",
                           grouped(peridynamics::count_bonds(lattice, wall.families(), wall.is_periodic())),
                           peridynamics::largest_family(lattice, wall.families(), wall.is_periodic())));
  // On one rank: on each they would take memory of their own.
  peridynamics::ElasticError error{};
  double limit = 0;
  parallel::on_root<RunError>(comm, [&] {
    error = peridynamics::elastic_error(wall.parameters, wall.setup);
    limit = peridynamics::linear_time_step_limit(wall.setup);
  });
  console.item("accuracy",
               fmt::format("{:.2g} % off Lame's static expansion, evenly over the wall to {:.2g} % "
                           "(surface correction {}, layer {})",
                           100 * error.relative_l2, 100 * error.spread,
                           name_of(peridynamics::surface_correction(wall.parameters)),
                           name_of(wall.parameters.layer)));
  console.item("strength", peridynamics::describe_strength(wall.parameters));
  if (c.model == scenes::Model::vessel) {
    console.item("load",
                 fmt::format("{} ({})", quantity(peridynamics::highest_pressure(wall.parameters), "Pa"),
                             peridynamics::describe_schedule(wall.parameters)));
    scenes::print_risk(console, wall.parameters);
  }
  console.item("time step",
               fmt::format("{} ({:.0f} % of the stable {}), {} steps", quantity(wall.time.step, "s"),
                           100 * wall.time.step / wall.time.stable, quantity(wall.time.stable, "s"),
                           grouped(wall.time.count)));
  console.item("instability",
               fmt::format("begins at {} where strains are small, {:.2f} times the stable step",
                           quantity(limit, "s"), limit / wall.time.stable));
  const std::string processors =
      fmt::format("{} rank{} x {} thread{}", comm.size(), comm.size() > 1 ? "s" : "",
                  parallel::thread_count(), parallel::thread_count() > 1 ? "s" : "");
  if (c.is_ensemble()) {
    const ensemble::Parameters& e = c.ensemble;
    console.item("pressures", fmt::format("{} from {} to {}", e.pressures.size(), mmhg(e.pressures.front()),
                                          mmhg(e.pressures.back())));
    console.item("samples",
                 fmt::format("{} = {} walls x {} pressures; the numbers above are of the mean wall",
                             grouped(e.vessels()), e.samples, e.pressures.size()));
    const double sample = step * static_cast<double>(wall.time.count);
    const auto rounds = (e.vessels() + comm.size() - 1) / comm.size();
    console.item("time",
                 fmt::format("at most about {} ({} a sample that lasts to the end; those that rupture "
                             "stop there) on {} (measured now)",
                             duration(sample * static_cast<double>(rounds)), duration(sample), processors));
    return;
  }
  console.item("outputs", grouped(static_cast<long long>(c.output_steps.size())));
  console.item("time",
               fmt::format("about {} of solving on {} (measured now; output and pictures come on top)",
                           duration(step * static_cast<double>(wall.time.count)), processors));
}

}  // namespace

void check(const Configuration& c, parallel::Communicator comm) {
  if (c.model == scenes::Model::network) {
    check_network(c, comm);
  } else if (c.is_coupled()) {
    // The wall is known when the network has been solved.
    Configuration solved = c;
    solved.network.statistics = false;
    runtime::Console console(comm.is_root(), false);
    console.line("Solving the network, which says what the wall and its load are:");
    scenes::NetworkCoupling coupling(solved, nullptr, comm, console);
    if (coupling.at_rest()) {
      console.line(
          fmt::format("{} is valid. No vessel's risk is above cascade.risk_limit = {}: no wall is simulated.",
                      c.file, text(c.coupling.risk_limit)));
      return;
    }
    const Configuration with_wall = coupling.with_wall();
    check_wall(with_wall, comm,
               [&](runtime::Console& to) { coupling.print_header(to, with_wall.wall->time.step); });
  } else {
    check_wall(c, comm, {});
  }
}

}  // namespace rhexis::app
