// SPDX-License-Identifier: BSD-3-Clause
// How probably a vessel ruptures, from many walls whose properties scatter.
#include "input/catalogue.hpp"
#include "input/description.hpp"
#include "scenes/scene_input.hpp"
#include "scenes/scenes.hpp"
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

}  // namespace

ParameterList declare_ensemble_scene(Configuration& c) {
  ParameterList all = ensemble::declare(c.ensemble);
  for (Parameter& parameter : declare_wall(c)) {
    if (parameter.key == "load.schedule") {
      parameter.choices = input::choices_of(parameter);
      std::erase(parameter.choices, name_of(peridynamics::Schedule::table));
    }
    if (!ensemble_sets(parameter.key)) all.push_back(parameter);
  }
  return all;
}

void resolve_ensemble_scene(Configuration& c, parallel::Communicator comm) {
  ensemble::resolve(c.ensemble);
  make_wall(c, comm);  // the mean one
  const auto warnings = ensemble::check_walls(c.ensemble, c.wall->parameters);
  c.warnings.insert(c.warnings.end(), warnings.begin(), warnings.end());
  warn_of_an_unfinished_ramp(c);
}

}  // namespace rhexis::scenes
