// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/coupled/coupled_scene.hpp"

#include <algorithm>

#include "core/format.hpp"
#include "hemodynamics/vessel_lines.hpp"
#include "input/catalogue.hpp"
#include "peridynamics/laws/correspondence/fibre_reinforced.hpp"
#include "peridynamics/monitors/particle_source.hpp"

namespace rhexis::scenes {
namespace {

/// Keys of a vessel that its network takes over.
bool network_sets(const std::string& key) {
  return input::section_of(key) == "vessel" || key == "load.pressure" || key == "load.table" ||
         key == "load.table_file" || key == "load.repeat" || key == "load.blood_density";
}

/// Keys of a network that its vessel takes over.
bool vessel_sets(const std::string& key) {
  return key == "wall.young_modulus" || key == "wall.poisson_ratio" || key == "screening.critical_stretch";
}

/// In two-way coupling the network says how the pressure falls.
void resolve_venting(CoupledScene& s) {
  if (!s.coupling.two_way()) return;
  if (s.vessel.venting != peridynamics::Venting::none && given(s, "load.venting"))
    throw InputError("not with coupling.mode = \"two_way\", where the network says how the pressure falls",
                     "load.venting");
  s.vessel.venting = peridynamics::Venting::none;
  warn_of_no_effect(s, "load.supply_area",
                    "with coupling.mode = \"two_way\": the network supplies the blood");
}

}  // namespace

ParameterList declare(CoupledScene& s) {
  ParameterList all = coupling::declare(s.coupling);
  for (const Parameter& parameter : declare_wall(s.vessel, s.output)) {
    if (!network_sets(parameter.key)) all.push_back(parameter);
  }
  for (const Parameter& parameter : declare_network(s.network)) {
    if (!vessel_sets(parameter.key)) all.push_back(parameter);
  }
  append(all, insitu::declare(s.pictures.insitu));
  return all;
}

void refuse_coupled_key(const std::string& key, const std::string& place) {
  if (network_sets(key)) throw InputError(place + ": the network says this of a coupled vessel");
  if (vessel_sets(key)) throw InputError(place + ": section [material] says this of a coupled network");
}

void resolve(CoupledScene& s, const Reading& reading) {
  check_fields(s.output, s.vessel.law);
  if (s.vessel.law.name == peridynamics::FibreReinforced::name && (s.is_cascade() || s.coupling.screens()))
    throw InputError(
        "vessels at risk are found by Hooke's law, which a wall with fibres does not follow; name the "
        "vessel (coupling.vessel), or take another law",
        "material.law");
  resolve_network(s, s.network, reading.comm);
  if (s.network.problem.is_tree() && !s.coupling.screens())
    hemodynamics::check_path(s.network.problem, s.coupling.vessel, "coupling.vessel");
  coupling::resolve(s.coupling, s.network.problem, s.vessel);
  if (s.vessel.spacing) warn_of_no_effect(s, "coupling.resolution", "where discretisation.spacing is given");
  resolve_venting(s);
  s.network.screening.critical_stretch = *s.vessel.critical_stretch;
  if (s.is_cascade() || s.coupling.screens())
    s.network.screening.top = std::max<std::int64_t>(1, s.network.screening.top);
  if (s.is_cascade()) warn_of_an_unfinished_ramp(s, s.vessel);
  warn_of_an_old_paraview(s, s.output.format);
  s.pictures.channels = {
      {"particles", names_of(peridynamics::ParticleSource::fields_of(s.vessel.law.by_gradient()))},
      {"network", names_of(hemodynamics::VesselLines().fields())}};
  find_scripts(s, s.pictures, reading);
}

VesselScene vessel_of(const CoupledScene& s) {
  return {s, s.vessel, s.output, s.pictures};
}

void resolve_coupled_wall(VesselScene& s, const Reading& reading) {
  try {
    peridynamics::WallDemand demand = demand_of(s.output, s.pictures, reading);
    demand.geometry_is_given = true;
    resolve_wall(s, demand, reading);
  } catch (const InputError& error) {
    if (!network_sets(error.key)) throw input::located(error, s.resolved);
    const peridynamics::Parameters& v = s.vessel;
    throw input::located(
        InputError(std::string(error.what()) + " (lumen radius " + quantity(v.inner_radius, "m") + ", wall " +
                       quantity(v.outer_radius - v.inner_radius, "m") + ", length " +
                       quantity(v.length, "m") + ")",
                   "coupling.vessel"),
        s.resolved);
  }
}

}  // namespace rhexis::scenes
