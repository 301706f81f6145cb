// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/vessel/wall_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/format.hpp"
#include "core/memory.hpp"
#include "parallel/together.hpp"
#include "peridynamics/loads/schedule.hpp"
#include "peridynamics/monitors/particle_source.hpp"
#include "runtime/version.hpp"
#include "studies/screening/screening.hpp"

namespace rhexis::scenes {
namespace {

/// Tells of the memory of a wall of `resolved` parameters, before it is checked or taken.
void tell_of_memory(const peridynamics::Parameters& resolved, const peridynamics::WallDemand& demand,
                    const runtime::PicturesPlan& pictures, const Reading& reading) {
  using peridynamics::megabytes;
  const peridynamics::WallMemory memory = peridynamics::memory_of(resolved, demand);
  const bool reads_scripts =
      pictures.insitu.enabled && !pictures.insitu.scripts.empty() && !runtime::paraview_version().empty();
  reading.tell("memory",
               fmt::format("about {} for the wall, {}; this check takes up to {}{}", megabytes(memory.run),
                           demand.one_each ? "on each rank" : "all ranks together",
                           megabytes(std::max(memory.check, reading.input_bytes)),
                           reads_scripts ? fmt::format(", and {} for ParaView to read the scripts",
                                                       megabytes(insitu::inspection_bytes))
                                         : ""));
}

void tell_of_a_long_wait(const peridynamics::Parameters& resolved, const Reading& reading) {
  constexpr double bonds_a_second = 1e6;  // or more: of making families and their weights
  const peridynamics::WallSize size = peridynamics::wall_size(resolved);
  if (size.bonds > 5 * bonds_a_second)
    reading.tell("", fmt::format("Making {:.3g} bonds of {:.3g} columns, which may take up to {}:",
                                 size.bonds, size.columns, duration(size.bonds / bonds_a_second)));
}

/// What the made wall shows of its input.
void warn_of_the_wall(SceneInput& s, const peridynamics::WallModel& wall) {
  if (wall.parameters.spots.thin_the_wall() && wall.setup.thin_spots.absent() == 0)
    s.warnings.push_back(
        "spot.thickness has no effect: a wall is thinned by whole particles, and none lies "
        "outside of what is left; take a smaller discretisation.spacing");
  const double end = static_cast<double>(wall.time.count) * wall.time.step;
  if (std::abs(wall.parameters.end_time - end) > 1e-3 * wall.time.step)
    s.warnings.push_back("time.end is not a whole number of steps; the run ends at " + quantity(end, "s", 6));
}

}  // namespace

ParameterList declare_wall(peridynamics::Parameters& vessel, output::Parameters& output) {
  ParameterList all = peridynamics::declare(vessel);
  append(all, output::declare(output, names_of(peridynamics::ParticleSource::fields_of(false)),
                              names_of(peridynamics::ParticleSource::all_fields())));
  return all;
}

void check_fields(const output::Parameters& output, const peridynamics::LawChoice& law) {
  const std::vector<std::string> known = names_of(peridynamics::ParticleSource::fields_of(law.by_gradient()));
  for (const std::string& field : output.fields) {
    if (std::ranges::find(known, field) == known.end())
      throw InputError("\"" + field + "\" is known of a law by deformation gradient only (material.law = " +
                           "\"neo_hookean\" or \"fibre_reinforced\")",
                       "output.fields");
  }
}

peridynamics::WallDemand demand_of(const output::Parameters& output, const runtime::PicturesPlan& pictures,
                                   const Reading& reading) {
  return {.use = {.ranks = reading.comm.size(),
                  .threads = parallel::thread_count(),
                  .outputs = !output.fields.empty() || pictures.insitu.enabled,
                  .doubles = output.precision == Precision::double_precision,
                  .checkpoints = output.checkpoint_every > 0},
          .only_checks = reading.only_checks};
}

peridynamics::SharedWall make_wall(SceneInput& s, const peridynamics::Parameters& vessel,
                                   const peridynamics::WallDemand& demand,
                                   const runtime::PicturesPlan& pictures, const Reading& reading) {
  peridynamics::Parameters resolved = vessel;
  append(s.warnings, peridynamics::resolve(resolved));
  if (reading.tell && reading.only_checks) tell_of_memory(resolved, demand, pictures, reading);
  peridynamics::require_memory(resolved, demand, reading.comm);
  if (reading.tell) tell_of_a_long_wait(resolved, reading);
  peridynamics::SharedWall wall;
  parallel::together(reading.comm, [&] {
    within_memory("the wall", "discretisation.spacing", [&] { wall = peridynamics::make_wall(resolved); });
  });
  warn_of_the_wall(s, *wall);
  return wall;
}

void warn_of_an_unfinished_ramp(SceneInput& s, const peridynamics::Parameters& vessel) {
  const double share = peridynamics::schedule_share(vessel, vessel.end_time);
  if (share < 1 - 1e-9)
    s.warnings.push_back("the ramp is not over at time.end: walls see " + text(100 * share, 3) +
                         " % of each pressure at most; shorten load.ramp_time, or end later");
}

std::optional<double> risk_of_load(const peridynamics::Parameters& v) {
  if (v.law.name == "fung" || v.law.name == "fibre_reinforced") return {};
  return screening::risk({*v.critical_stretch, v.young_modulus, v.law.poisson_ratio, 0},
                         peridynamics::highest_pressure(v), v.outer_radius / v.inner_radius - 1, {1, 1});
}

}  // namespace rhexis::scenes
