// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/vessel/vessel_scene.hpp"

#include <fmt/format.h>

#include "core/format.hpp"
#include "core/text_file.hpp"
#include "input/units.hpp"
#include "parallel/together.hpp"
#include "peridynamics/loads/schedule.hpp"
#include "peridynamics/loads/schedule_table.hpp"
#include "peridynamics/monitors/particle_source.hpp"

namespace rhexis::scenes {
namespace {

/// Reads load.table_file, where there is one, into load.table.
void read_table(VesselScene& s, parallel::Communicator comm) {
  constexpr const char* key = "load.table_file";
  peridynamics::Parameters& v = s.vessel;
  if (v.table_file.empty()) return;
  if (!v.table.empty()) throw InputError("give either load.table or load.table_file, not both", key);
  std::vector<std::string> files{v.table_file};
  find_files(files, key, "table", s.file, comm);
  v.table_file = files.front();
  check_key(key, [&] {
    std::string text;
    constexpr std::uintmax_t most = 1'000'000'000;
    parallel::on_root<InputError>(comm,
                                  [&] { text = whole_file(v.table_file, most, ", too much for a table"); });
    text = comm.broadcast(text);
    s.checksums.emplace_back(key, peridynamics::checksum(text));
    parallel::together<InputError>(
        comm, [&] { v.table = peridynamics::schedule_table(v.table_file, std::move(text), input::to_si); });
  });
}

/// A slip in a unit is a factor of ten at least.
void warn_of_a_load_beyond_all(VesselScene& s) {
  constexpr double beyond_all = 5;
  const std::optional<double> risk = risk_of_load(s.wall->parameters);
  if (!risk || *risk < beyond_all) return;
  s.warnings.push_back(fmt::format(
      "under {} the lumen would stretch to {:.3g} times material.critical_stretch: the wall is blown "
      "to pieces at a small part of this load; check the units",
      quantity(peridynamics::highest_pressure(s.wall->parameters), "Pa"), *risk));
}

}  // namespace

ParameterList declare(VesselScene& s) {
  ParameterList all = declare_wall(s.vessel, s.output);
  append(all, peridynamics::declare_start(s.vessel));
  append(all, insitu::declare(s.pictures.insitu));
  return all;
}

void resolve(VesselScene& s, const Reading& reading) {
  check_fields(s.output, s.vessel.law);
  read_table(s, reading.comm);
  resolve_wall(s, demand_of(s.output, s.pictures, reading), reading);
  if (s.output.fields.empty()) warn_of_no_effect(s, "output.format", "without output.fields");
  warn_of_a_load_beyond_all(s);
  if (!s.output.fields.empty()) warn_of_an_old_paraview(s, s.output.format);
  s.pictures.channels = {
      {"particles", names_of(peridynamics::ParticleSource::fields_of(s.vessel.law.by_gradient()))}};
  find_scripts(s, s.pictures, reading);
}

void resolve_wall(VesselScene& s, const peridynamics::WallDemand& demand, const Reading& reading) {
  s.wall = make_wall(s, s.vessel, demand, s.pictures, reading);
  if (s.output.fields.empty()) warn_of_no_effect(s, "output.precision", "without output.fields");
  s.output_steps = output::planned_steps(s.output, s.wall->time.count, s.wall->time.step);
}

}  // namespace rhexis::scenes
