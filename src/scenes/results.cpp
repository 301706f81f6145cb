// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/results.hpp"

#include "output/json.hpp"

namespace rhexis::scenes {
namespace {

using output::or_null;
using Json = nlohmann::ordered_json;

}  // namespace

void to_json(Json& json, const Results& results) {
  json = Json::object({{"particles", or_null(results.particles)},
                       {"bonds", or_null(results.bonds)},
                       {"family_max", or_null(results.family_max)},
                       {"time_step_s", or_null(results.time_step_s)},
                       {"stable_time_step_s", or_null(results.stable_time_step_s)},
                       {"steps", or_null(results.steps)},
                       {"simulated_s", or_null(results.simulated_s)},
                       {"first_bond_break_s", or_null(results.first_bond_break_s)},
                       {"rupture_onset_s", or_null(results.rupture_onset_s)},
                       {"pressure_at_onset_Pa", or_null(results.pressure_at_onset_Pa)},
                       {"blood_pressure_at_onset_Pa", or_null(results.blood_pressure_at_onset_Pa)},
                       {"max_displacement_at_onset_m", or_null(results.max_displacement_at_onset_m)},
                       {"max_displacement_m", or_null(results.max_displacement_m)},
                       {"max_damage", or_null(results.max_damage)},
                       {"rupture_length_m", or_null(results.rupture_length_m)},
                       {"opening_area_m2", or_null(results.opening_area_m2)},
                       {"energy_drift", or_null(results.energy_drift)},
                       {"network", results.network},
                       {"coupling", results.coupling},
                       {"cascade", results.cascade},
                       {"ensemble", results.ensemble}});
}

}  // namespace rhexis::scenes
