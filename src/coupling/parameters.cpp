// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/parameters.hpp"

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/laws/strength.hpp"

namespace rhexis::coupling {

ParameterList declare(Parameters& p) {
  return {
      {.key = "coupling.vessel",
       .target = &p.vessel,
       .meaning = "The vessel whose wall is simulated: its path in a tree (\"artery.0110\"), its id, its "
                  "name in a file, or \"screening\": the one at highest risk.",
       .source = "Sec. 3.3",
       .required = true},
      {.key = "coupling.mode",
       .target = &p.mode,
       .meaning = "one_way: the network loads the wall, as in the paper; two_way: the wall's lumen and leak "
                  "change the network as well.",
       .source = "Sec. 3.3"},
      {.key = "coupling.window",
       .target = &p.window,
       .unit = "s",
       .meaning = "Time between exchanges with the network where mode is two_way; \"auto\" is a "
                  "two-hundredth of time.end.",
       .range = Range::positive(),
       .only_with = {when("coupling.mode", Mode::two_way)}},
      {.key = "coupling.resolution",
       .target = &p.resolution,
       .meaning = "paper: discretisation.particles for the whole vessel; auto: as the paper, but where that "
                  "leaves fewer than 4 spacings across the wall, only the middle piece that so many "
                  "particles fill at 5 across.",
       .source = "Sec. 3.3"},
      {.key = "coupling.radius_of",
       .target = &p.radius_of,
       .meaning = "Which radius a wall has whose vessel, from centre lines, varies along it: the simulated "
                  "wall is straight."},
      {.key = "cascade.events",
       .target = &p.events,
       .unit = "1",
       .meaning =
           "After a vessel has ruptured the flow is found again, and the vessel that is now at highest risk "
           "is simulated next: this many at most; 0: only coupling.vessel. Needs an explicit network.",
       .range = Range::between(0, 1000)},
      {.key = "cascade.outcome",
       .target = &p.outcome,
       .meaning = "What a ruptured vessel does from then on: it bleeds through the opening that it had at "
                  "the end, or it is occluded (a clot, a clamp, a spasm) and the others carry its flow.",
       .only_with = {{"cascade.events", {}}}},
      {.key = "cascade.risk_limit",
       .target = &p.risk_limit,
       .unit = "1",
       .meaning = "The cascade ends when no vessel's risk (strain over critical stretch) is above this.",
       .range = Range::positive(),
       .only_with = {{"cascade.events", {}}}},
      {.key = "body.tissue_tension",
       .target = &p.tension,
       .unit = "Pa",
       .meaning = "Pressure of the tissue around the vessel, P_t.",
       .source = "Eq. (7)"},
      {.key = "body.atmosphere",
       .target = &p.atmosphere,
       .unit = "Pa",
       .meaning = "Atmospheric pressure around the body, P_atm, over that to which the network's pressures "
                  "are relative.",
       .source = "Eq. (7)"},
      {.key = "body.compression",
       .target = &p.compression,
       .unit = "Pa",
       .meaning = "Pressure of a cuff or g-suit on the vessel, P_comp.",
       .source = "Eq. (7)",
       .range = Range::not_negative()},
      {.key = "body.compression_axis",
       .target = &p.compression_axis,
       .meaning = "Axis along which the compression's range is measured.",
       .only_with = {{"body.compression", {}}}},
      {.key = "body.compression_from",
       .target = &p.compression_from,
       .unit = "m",
       .meaning = "Where the compressed part of the body begins along that axis; \"auto\": everywhere.",
       .only_with = {{"body.compression", {}}}},
      {.key = "body.compression_to",
       .target = &p.compression_to,
       .unit = "m",
       .meaning = "Where it ends.",
       .only_with = {{"body.compression", {}}}},
  };
}

void resolve(const Parameters& p, hemodynamics::FlowProblem& network, peridynamics::Parameters& vessel) {
  const bool is_cascade = p.events > 0, is_tree = network.is_tree();
  const network::Tier tier = network.network.tier;
  if (tier == network::Tier::distributed_graph)
    throw InputError("a coupled vessel needs an implicit or explicit network", "network.tier");
  if (vessel.schedule == peridynamics::Schedule::table)
    throw InputError("the network says the pressure; a schedule by table is for scenes of one vessel",
                     "load.schedule");
  if (p.window && *p.window > vessel.end_time)
    throw InputError("longer than the run, time.end = " + quantity(vessel.end_time, "s"), "coupling.window");
  if (p.compression_from && p.compression_to && *p.compression_from >= *p.compression_to)
    throw InputError("must be above body.compression_from", "body.compression_to");
  if (vessel.energy_release_rate && !vessel.horizon)
    throw InputError(
        "before the network is solved no spacing is known, and so no critical stretch; give "
        "discretisation.horizon, or material.critical_stretch",
        "material.energy_release_rate");
  if (is_cascade && is_tree && tier != network::Tier::explicit_graph)
    throw InputError("a cascade needs network.tier = \"explicit\"", "cascade.events");
  if (is_cascade && network.blood.phase_separation)
    throw InputError("not with blood.phase_separation", "cascade.events");
  if ((p.two_way() || is_cascade) && is_tree && !network.blood.outlet_pressure)
    throw InputError("needed where a tree bleeds: what then leaves it is less than flow.inlet_flow",
                     "flow.outlet_pressure");
  vessel.blood_density = network.blood.density;
  network.network.wall.young_modulus = vessel.young_modulus;
  network.network.wall.poisson_ratio = vessel.law.poisson_ratio;
  peridynamics::resolve_critical_stretch(vessel);
}

Compression compression(const Parameters& p) {
  Compression c;
  c.pressure = p.compression;
  c.axis = static_cast<int>(p.compression_axis);
  c.from = p.compression_from.value_or(c.from);
  c.to = p.compression_to.value_or(c.to);
  return c;
}

double outside_everywhere(const Parameters& p) {
  PressureParts parts;
  parts.tension = p.tension;
  parts.atmosphere = p.atmosphere;
  if (!p.compression_from && !p.compression_to) parts.compression = p.compression;
  return parts.outside();
}

}  // namespace rhexis::coupling
