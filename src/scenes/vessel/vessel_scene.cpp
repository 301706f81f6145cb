// SPDX-License-Identifier: BSD-3-Clause
// The rupture of one vessel's wall.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/format.hpp"
#include "core/memory.hpp"
#include "core/text_file.hpp"
#include "input/units.hpp"
#include "parallel/together.hpp"
#include "peridynamics/loads/schedule.hpp"
#include "peridynamics/loads/schedule_table.hpp"
#include "peridynamics/monitors/particle_source.hpp"
#include "scenes/scene_input.hpp"
#include "scenes/scenes.hpp"
#include "scenes/vessel/wall_memory.hpp"
#include "studies/screening/screening.hpp"

namespace rhexis::scenes {
namespace {

/// Reads load.table_file, where there is one, into load.table.
void read_table(Configuration& c, parallel::Communicator comm) {
  peridynamics::Parameters& v = c.vessel;
  if (v.table_file.empty()) return;
  if (!v.table.empty())
    throw InputError("give either load.table or load.table_file, not both", "load.table_file");
  std::vector<std::string> files{v.table_file};
  find_files(files, "load.table_file", "table", c.file, comm);
  v.table_file = files.front();
  check_key("load.table_file", [&] {
    std::string text;
    constexpr std::uintmax_t most = 1'000'000'000;
    parallel::on_root<InputError>(comm,
                                  [&] { text = whole_file(v.table_file, most, ", too much for a table"); });
    text = comm.broadcast(text);
    c.table_checksum = peridynamics::checksum(text);
    parallel::together<InputError>(
        comm, [&] { v.table = peridynamics::schedule_table(v.table_file, std::move(text), input::to_si); });
  });
}

/// What the made wall shows of its input.
void warn_of_the_wall(Configuration& c) {
  const peridynamics::WallModel& wall = *c.wall;
  if (wall.parameters.spots.thin_the_wall() && wall.setup.thin_spots.absent() == 0)
    c.warnings.push_back(
        "spot.thickness has no effect: a wall is thinned by whole particles, and none lies "
        "outside of what is left; take a smaller discretisation.spacing");
  const double end = static_cast<double>(wall.time.count) * wall.time.step;
  if (std::abs(wall.parameters.end_time - end) > 1e-3 * wall.time.step) {
    c.warnings.push_back("time.end is not a whole number of steps; the run ends at " + quantity(end, "s", 6));
  }
}

/// A slip in a unit is a factor of ten at least.
void warn_of_a_load_beyond_all(Configuration& c) {
  constexpr double beyond_all = 5;
  const std::optional<double> risk = risk_of_load(c.wall->parameters);
  if (!risk || *risk < beyond_all) return;
  c.warnings.push_back(fmt::format(
      "under {} the lumen would stretch to {:.3g} times material.critical_stretch: the wall is blown "
      "to pieces at a small part of this load; check the units",
      quantity(peridynamics::highest_pressure(c.wall->parameters), "Pa"), *risk));
}

}  // namespace

ParameterList declare_wall(Configuration& c) {
  ParameterList all = peridynamics::declare(c.vessel);
  std::vector<std::string> fields;
  for (const FieldInfo& field : peridynamics::ParticleSource::all_fields()) fields.emplace_back(field.name);
  append(all, output::declare(c.output, fields));
  return all;
}

void make_wall(Configuration& c, parallel::Communicator comm) {
  peridynamics::Parameters resolved = c.vessel;
  const auto warnings = peridynamics::resolve(resolved);
  c.warnings.insert(c.warnings.end(), warnings.begin(), warnings.end());
  check_memory(c, resolved, comm);
  parallel::together(comm, [&] {
    within_memory("the wall", "discretisation.spacing", [&] { c.wall = peridynamics::make_wall(resolved); });
  });
  warn_of_the_wall(c);
  if (c.is_ensemble()) return;
  if (c.output.fields.empty()) warn_of_no_effect(c, "output.precision", "without output.fields");
  if (c.output.fields.empty() && !c.is_coupled())
    warn_of_no_effect(c, "output.format", "without output.fields");
  c.output_steps = output::planned_steps(c.output, c.wall->time.count, c.wall->time.step);
}

void warn_of_an_unfinished_ramp(Configuration& c) {
  const double share = peridynamics::schedule_share(c.vessel, c.vessel.end_time);
  if (share < 1 - 1e-9)
    c.warnings.push_back("the ramp is not over at time.end: walls see " + text(100 * share, 3) +
                         " % of each pressure at most; shorten load.ramp_time, or end later");
}

std::optional<double> risk_of_load(const peridynamics::Parameters& v) {
  if (v.law.name == "fung") return {};
  return screening::risk({*v.critical_stretch, v.young_modulus, v.law.poisson_ratio, 0},
                         peridynamics::highest_pressure(v), v.outer_radius / v.inner_radius - 1, {1, 1});
}

ParameterList declare_vessel_scene(Configuration& c) {
  ParameterList all = declare_wall(c);
  append(all, peridynamics::declare_start(c.vessel));
  append(all, insitu::declare(c.insitu));
  return all;
}

void resolve_vessel_scene(Configuration& c, parallel::Communicator comm) {
  read_table(c, comm);
  make_wall(c, comm);
  warn_of_a_load_beyond_all(c);
}

}  // namespace rhexis::scenes
