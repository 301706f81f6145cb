// SPDX-License-Identifier: BSD-3-Clause
// The rupture of a vessel of a network.
#include <algorithm>

#include "core/format.hpp"
#include "input/catalogue.hpp"
#include "peridynamics/laws/strength.hpp"
#include "scenes/scene_input.hpp"
#include "scenes/scenes.hpp"

namespace rhexis::scenes {

bool network_sets(const std::string& key) {
  return input::section_of(key) == "vessel" || key == "load.pressure" || key == "load.table" ||
         key == "load.table_file" || key == "load.repeat" || key == "load.blood_density";
}

bool vessel_sets(const std::string& key) {
  return key == "wall.young_modulus" || key == "wall.poisson_ratio" || key == "screening.critical_stretch";
}

ParameterList declare_coupled_scene(Configuration& c) {
  ParameterList all = coupling::declare(c.coupling);
  for (const Parameter& parameter : declare_wall(c)) {
    if (!network_sets(parameter.key)) all.push_back(parameter);
  }
  for (const Parameter& parameter : declare_network(c)) {
    if (!vessel_sets(parameter.key)) all.push_back(parameter);
  }
  append(all, insitu::declare(c.insitu));
  return all;
}

void resolve_coupled_scene(Configuration& c, parallel::Communicator comm) {
  resolve_network(c, comm);
  coupling::Parameters& p = c.coupling;
  if (c.network.tier == network::Tier::distributed_graph)
    throw InputError("a coupled vessel needs an implicit or explicit network", "network.tier");
  if (c.vessel.schedule == peridynamics::Schedule::table)
    throw InputError("the network says the pressure; a schedule by table is for scenes of one vessel",
                     "load.schedule");
  if (c.vessel.spacing) warn_of_no_effect(c, "coupling.resolution", "where discretisation.spacing is given");
  if (p.window && *p.window > c.vessel.end_time)
    throw InputError("longer than the run, time.end = " + quantity(c.vessel.end_time, "s"),
                     "coupling.window");
  if (p.two_way()) {
    if (c.vessel.venting != peridynamics::Venting::none && given(c, "load.venting"))
      throw InputError("not with coupling.mode = \"two_way\", where the network says how the pressure falls",
                       "load.venting");
    c.vessel.venting = peridynamics::Venting::none;
    warn_of_no_effect(c, "load.supply_area",
                      "with coupling.mode = \"two_way\": the network supplies the blood");
  }
  if (p.compression_from && p.compression_to && *p.compression_from >= *p.compression_to)
    throw InputError("must be above body.compression_from", "body.compression_to");
  c.vessel.blood_density = c.hemodynamics.density;
  c.network.wall.young_modulus = c.vessel.young_modulus;
  c.network.wall.poisson_ratio = c.vessel.law.poisson_ratio;
  if (c.vessel.energy_release_rate && !c.vessel.horizon)
    throw InputError(
        "before the network is solved no spacing is known, and so no critical stretch; give "
        "discretisation.horizon, or material.critical_stretch",
        "material.energy_release_rate");
  peridynamics::resolve_critical_stretch(c.vessel);
  c.screening.critical_stretch = *c.vessel.critical_stretch;
  if (p.events > 0 && c.network.is_tree() && c.network.tier != network::Tier::explicit_graph)
    throw InputError("a cascade needs network.tier = \"explicit\"", "cascade.events");
  if (p.events > 0 && c.hemodynamics.phase_separation)
    throw InputError("not with blood.phase_separation", "cascade.events");
  if (p.events > 0) {
    c.screening.top = std::max<std::int64_t>(1, c.screening.top);
    warn_of_an_unfinished_ramp(c);
  }
  const hemodynamics::Parameters& h = c.hemodynamics;
  if ((p.two_way() || p.events > 0) && c.network.is_tree() && !h.outlet_pressure)
    throw InputError("needed where a tree bleeds: what then leaves it is less than flow.inlet_flow",
                     "flow.outlet_pressure");
  if (p.screens()) c.screening.top = std::max<std::int64_t>(1, c.screening.top);
}

void resolve_coupled_wall(Configuration& c, parallel::Communicator comm) {
  try {
    make_wall(c, comm);
  } catch (const InputError& error) {
    if (!network_sets(error.key)) throw input::located(error, c.resolved);
    const peridynamics::Parameters& v = c.vessel;
    throw input::located(
        InputError(std::string(error.what()) + " (lumen radius " + quantity(v.inner_radius, "m") + ", wall " +
                       quantity(v.outer_radius - v.inner_radius, "m") + ", length " +
                       quantity(v.length, "m") + ")",
                   "coupling.vessel"),
        c.resolved);
  }
}

}  // namespace rhexis::scenes
