// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/parameters.hpp"

#include "core/error.hpp"
#include "network/parameters.hpp"

namespace rhexis::hemodynamics {

ParameterList declare(Parameters& p) {
  return {
      {.key = "blood.viscosity_law",
       .target = &p.viscosity.law,
       .meaning =
           "Apparent viscosity: constant, or rising and falling with the diameter as measured in glass tubes "
           "(in_vitro: Pries et al. 1992) or in living tissue (in_vivo: Pries et al. 1994).",
       .source = "Eq. (9)"},
      {.key = "blood.viscosity",
       .target = &p.viscosity.constant,
       .unit = "Pa s",
       .default_in = "mPa s",
       .meaning = "Viscosity of the law \"constant\".",
       .source = "Eq. (9)",
       .range = Range::positive(),
       .only_with = {when("blood.viscosity_law", ViscosityLaw::constant)}},
      {.key = "blood.plasma_viscosity",
       .target = &p.viscosity.plasma,
       .unit = "Pa s",
       .default_in = "mPa s",
       .meaning = "Viscosity of plasma, of the laws that depend on the diameter.",
       .range = Range::positive(),
       .only_with = {when("blood.viscosity_law", ViscosityLaw::in_vitro, ViscosityLaw::in_vivo)}},
      {.key = "blood.haematocrit",
       .target = &p.viscosity.haematocrit,
       .unit = "1",
       .meaning = "Discharge haematocrit: share of red cells in the blood that enters.",
       .range = Range::between(0.001, 0.95)},
      {.key = "blood.least_diameter",
       .target = &p.viscosity.least_diameter,
       .unit = "m",
       .default_in = "um",
       .meaning = "A vessel narrower than this has the viscosity of this diameter: the laws were not "
                  "measured below 3 um, and the one in vivo is infinite at 1.1 um.",
       .range = Range{.lower = 1.15e-6, .upper = 1e-5},
       .only_with = {when("blood.viscosity_law", ViscosityLaw::in_vitro, ViscosityLaw::in_vivo)}},
      {.key = "blood.mean_cell_volume",
       .target = &p.viscosity.mean_cell_volume,
       .unit = "m3",
       .default_in = "fL",
       .meaning = "Mean volume of a red cell: the laws that depend on the diameter take it times the cube "
                  "root of 92 fL, which is man's, over this; about 55 fL in rats.",
       .source = "Secomb's NetFlow",
       .range = Range::between(1e-17, 3e-16),
       .only_with = {when("blood.viscosity_law", ViscosityLaw::in_vitro, ViscosityLaw::in_vivo)}},
      {.key = "blood.density",
       .target = &p.density,
       .unit = "kg/m3",
       .meaning = "Of blood, for the pressure of its weight, Reynolds numbers and a coupled vessel's leak.",
       .source = "Eq. (7)",
       .range = Range::positive()},
      {.key = "blood.phase_separation",
       .target = &p.phase_separation,
       .meaning = "Explicit networks: red cells divide unevenly at bifurcations, so that every vessel has "
                  "its own haematocrit.",
       .source = "Pries & Secomb 2008"},
      {.key = "blood.phase_tolerance",
       .target = &p.phase_tolerance,
       .unit = "1",
       .meaning = "Stop when no vessel's haematocrit changes more in an iteration.",
       .range = Range::between(1e-14, 0.1),
       .only_with = {{"blood.phase_separation", {"true"}}}},
      {.key = "blood.phase_iterations",
       .target = &p.phase_iterations,
       .unit = "1",
       .meaning = "The most iterations.",
       .range = Range::at_least(1),
       .only_with = {{"blood.phase_separation", {"true"}}}},
      {.key = "flow.inlet_pressure",
       .target = &p.inlet_pressure,
       .unit = "Pa",
       .meaning = "Pressure where blood enters a tree, relative to atmosphere. Of it, outlet_pressure and "
                  "inlet_flow give two.",
       .source = "Sec. 3.3"},
      {.key = "flow.outlet_pressure",
       .target = &p.outlet_pressure,
       .unit = "Pa",
       .meaning = "Pressure where blood leaves a tree.",
       .source = "Sec. 3.3"},
      {.key = "flow.inlet_flow",
       .target = &p.inlet_flow,
       .unit = "m3/s",
       .meaning = "Flow into a tree.",
       .source = "Sec. 3.3",
       .range = Range::positive()},
      {.key = "flow.acceleration",
       .target = &p.acceleration,
       .unit = "m/s2",
       .meaning = "Gravity, or the body's acceleration, as three components: adds the weight of the blood to "
                  "pressures (hydrostatic term).",
       .source = "Eq. (7)"},
  };
}

ParameterList declare(GraphSolverOptions& options) {
  const std::vector<Condition> a_graph{
      when("network.source", network::Source::file),
      when("network.tier", network::Tier::explicit_graph, network::Tier::distributed_graph)};
  return {
      {.key = "network.solver",
       .target = &options.solver,
       .meaning =
           "For what is left of an explicit network when dead ends, series and parallels are eliminated: "
           "nothing may be left (elimination), direct (ldlt), or conjugate gradients with a preconditioner.",
       .only_with = a_graph},
      {.key = "network.imbalance",
       .target = &options.imbalance,
       .unit = "1",
       .meaning = "Stop when blood is conserved at the worst junction to this share of the inflow.",
       .range = Range::between(1e-15, 1e-3),
       .only_with = a_graph},
      {.key = "network.max_iterations",
       .target = &options.max_iterations,
       .unit = "1",
       .meaning = "Of an iterative solver.",
       .range = Range::at_least(1),
       .only_with = a_graph},
  };
}

void check(const Parameters& p) {
  if (!p.acceleration.empty() && p.acceleration.size() != 3) {
    throw InputError("needs three components, or none", "flow.acceleration");
  }
}

TreeBoundary tree_boundary(const Parameters& p) {
  const int given = p.inlet_pressure.has_value() + p.outlet_pressure.has_value() + p.inlet_flow.has_value();
  if (given != 2) {
    throw InputError("a tree needs two of flow.inlet_pressure, flow.outlet_pressure and flow.inlet_flow; " +
                         std::to_string(given) + " are given",
                     p.inlet_pressure    ? "flow.inlet_pressure"
                     : p.outlet_pressure ? "flow.outlet_pressure"
                                         : "flow.inlet_flow");
  }
  return {p.inlet_pressure, p.outlet_pressure, p.inlet_flow};
}

}  // namespace rhexis::hemodynamics
