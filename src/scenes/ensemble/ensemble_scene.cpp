// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/ensemble/ensemble_scene.hpp"

#include "input/catalogue.hpp"
#include "input/description.hpp"
#include "scenes/ensemble/ensemble_run.hpp"
#include "studies/ensemble/walls.hpp"

namespace rhexis::scenes {
namespace {

/// Keys of a vessel that an ensemble takes over, or that do nothing there: walls take a stable time step
/// each, and are simulated to the onset of rupture, before any venting and without output.
bool ensemble_sets(const std::string& key) {
  return input::section_of(key) == "output" || key == "load.pressure" || key == "load.table" ||
         key == "load.table_file" || key == "load.repeat" || key == "load.venting" ||
         key == "load.supply_area" || key == "load.discharge_coefficient" || key == "load.blood_density" ||
         key == "time.step" || key == "time.allow_unstable";
}

/// Each rank simulates walls of its own.
peridynamics::WallDemand demand_of(const EnsembleScene& s, const Reading& reading) {
  constexpr double thickest = 3;  // standard deviations
  return {.use = {.ranks = 1, .threads = parallel::thread_count(), .outputs = false},
          .one_each = true,
          .variation = 1 + thickest * s.ensemble.thickness_spread,
          .only_checks = reading.only_checks};
}

}  // namespace

ParameterList declare(EnsembleScene& s) {
  output::Parameters unused;  // an ensemble has none of its keys
  ParameterList all = ensemble::declare(s.ensemble);
  for (Parameter& parameter : declare_wall(s.vessel, unused)) {
    if (parameter.key == "load.schedule") {
      parameter.choices = input::choices_of(parameter);
      std::erase(parameter.choices, name_of(peridynamics::Schedule::table));
    }
    if (!ensemble_sets(parameter.key)) all.push_back(parameter);
  }
  return all;
}

void resolve(EnsembleScene& s, const Reading& reading) {
  ensemble::resolve(s.ensemble);
  s.wall = make_wall(s, s.vessel, demand_of(s, reading), {}, reading);
  append(s.warnings, ensemble::check_walls(s.ensemble, s.wall->parameters));
  warn_of_an_unfinished_ramp(s, s.vessel);
}

output::FolderPlan folder_plan(const EnsembleScene& s, const runtime::RunOptions& options) {
  output::FolderPlan plan = plan_of_folder(s, options, {});
  plan.writes.names = {"run.json", samples_name, probability_name};
  return plan;
}

}  // namespace rhexis::scenes
