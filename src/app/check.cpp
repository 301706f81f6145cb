// SPDX-License-Identifier: BSD-3-Clause
#include "app/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "app/network_coupling.hpp"
#include "app/vessel_run.hpp"
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
#include "runtime/console.hpp"

namespace rhexis::app {
namespace {

using peridynamics::BondFamilies;
using peridynamics::Lattice;

/// Seconds one step of the whole body takes on these ranks, from a few steps of a short piece of it.
double seconds_per_step(const Configuration& c, const Lattice& lattice, parallel::Communicator comm) {
  constexpr int timed_steps = 10;
  Lattice piece = lattice;
  piece.rows = std::min<std::int64_t>(lattice.rows, 64L * comm.size());
  peridynamics::Parameters parameters = c.vessel;
  parameters.ends = "free";
  const auto body =
      peridynamics::make_body(peridynamics::make_setup(parameters, piece, c.families, c.time_step), comm);
  body->advance(0, 0);  // warms caches and pages
  const double start = seconds_now();
  for (int i = 0; i < timed_steps; ++i) body->advance(0, 0);
  const double elapsed = seconds_now() - start;
  return comm.all_reduce(elapsed, parallel::Reduce::max) / timed_steps * static_cast<double>(lattice.rows) /
         static_cast<double>(piece.rows);
}

/// `say_more`: what else there is to say of the vessel.
void check_wall(const Configuration& c, parallel::Communicator comm,
                const std::function<void(runtime::Console&)>& say_more) {
  const Lattice lattice = peridynamics::make_lattice(c.vessel);
  const BondFamilies& families = *c.families;
  const bool periodic = peridynamics::end_condition(c.vessel) == peridynamics::EndCondition::axial_periodic;
  // A sample of an ensemble belongs to one rank, while the others have theirs.
  const double step =
      comm.all_reduce(seconds_per_step(c, lattice, c.is_ensemble() ? parallel::Communicator::self() : comm),
                      parallel::Reduce::max);

  runtime::Console console(comm.is_root(), false);
  console.line(c.file + " is valid.");
  for (const std::string& warning : c.warnings) console.warning(warning);
  if (say_more) say_more(console);
  console.item("spacing", quantity(lattice.spacing, "m") +
                              fmt::format(" ({:.1f} across the wall), {} between rows",
                                          (c.vessel.outer_radius - c.vessel.inner_radius) / lattice.spacing,
                                          quantity(lattice.row_spacing, "m")));
  console.item("horizon", quantity(lattice.horizon, "m") +
                              fmt::format(" ({:.4g} spacings)", lattice.horizon / lattice.spacing));
  const peridynamics::BodySetup setup = peridynamics::make_setup(c.vessel, lattice, c.families, c.time_step);
  const std::int64_t absent = setup.thin_spots.absent();
  console.item(
      "particles",
      fmt::format("{} = {} columns x {} rows{}", grouped(lattice.particles() - absent),
                  lattice.section.size(), lattice.rows,
                  absent > 0 ? fmt::format(" less the {} that thin spots leave out", grouped(absent)) : ""));
  console.item("bonds", fmt::format("{}{}, at most {} a particle", absent > 0 ? "fewer than " : "",
                                    grouped(peridynamics::count_bonds(lattice, families, periodic)),
                                    peridynamics::largest_family(lattice, families, periodic)));
  // On one rank: on each they would take memory of their own.
  peridynamics::ElasticError error{};
  double limit = 0;
  parallel::on_root<RunError>(comm, [&] {
    error = peridynamics::elastic_error(c.vessel, setup);
    limit = peridynamics::linear_time_step_limit(setup);
  });
  console.item("accuracy",
               fmt::format("{:.2g} % off Lame's static expansion, evenly over the wall to {:.2g} % "
                           "(surface correction {}, layer {})",
                           100 * error.relative_l2, 100 * error.spread,
                           peridynamics::surface_correction(c.vessel), c.vessel.layer));
  console.item("strength", peridynamics::describe_strength(c.vessel));
  if (c.model == "vessel") {
    console.item("load", fmt::format("{} ({})", quantity(peridynamics::highest_pressure(c.vessel), "Pa"),
                                     peridynamics::describe_schedule(c.vessel)));
    print_risk(console, c.vessel);
  }
  console.item("time step", fmt::format("{} ({:.0f} % of the stable {}), {} steps",
                                        quantity(c.time_step, "s"), 100 * c.time_step / c.stable_time_step,
                                        quantity(c.stable_time_step, "s"), grouped(c.steps)));
  console.item("instability",
               fmt::format("begins at {} where strains are small, {:.2f} times the stable step",
                           quantity(limit, "s"), limit / c.stable_time_step));
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
    const double sample = step * static_cast<double>(c.steps);
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
                           duration(step * static_cast<double>(c.steps)), processors));
}

}  // namespace

void check(const Configuration& c, parallel::Communicator comm) {
  if (c.model == "network") {
    check_network(c, comm);
  } else if (c.is_coupled()) {
    // The wall is known when the network has been solved.
    Configuration solved = c;
    solved.network.statistics = false;
    runtime::Console console(comm.is_root(), false);
    console.line("Solving the network, which says what the wall and its load are:");
    NetworkCoupling coupling(solved, nullptr, comm, console);
    if (coupling.at_rest()) {
      console.line(
          fmt::format("{} is valid. No vessel's risk is above cascade.risk_limit = {}: no wall is simulated.",
                      c.file, text(c.coupling.risk_limit)));
      return;
    }
    const Configuration with_wall = coupling.with_wall();
    check_wall(with_wall, comm,
               [&](runtime::Console& to) { coupling.print_header(to, with_wall.time_step); });
  } else {
    check_wall(c, comm, {});
  }
}

}  // namespace rhexis::app
