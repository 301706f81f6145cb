#include "hemodynamics/parameters.hpp"

#include "core/error.hpp"

namespace rhexis::hemodynamics {

ParameterList declare(Parameters& p) {
  return {
      {"blood.viscosity_law",
       &p.viscosity_law,
       "",
       "\"in_vivo\"",
       "Apparent viscosity: constant, or rising and falling with the diameter as measured in glass tubes "
       "(in_vitro: "
       "Pries et al. 1992) or in living tissue (in_vivo: Pries et al. 1994).",
       "Eq. (9)",
       {},
       {"constant", "in_vitro", "in_vivo"}},
      only_with({"blood.viscosity_law", {"\"constant\""}},
                {"blood.viscosity", &p.viscosity.constant, "Pa s", "\"3.5 mPa s\"",
                 "Viscosity of the law \"constant\".", "Eq. (9)", Range::positive()}),
      only_with({"blood.viscosity_law", {"\"in_vitro\"", "\"in_vivo\""}},
                {"blood.plasma_viscosity", &p.viscosity.plasma, "Pa s", "\"1.0466 mPa s\"",
                 "Viscosity of plasma, of the laws that depend on the diameter.", "", Range::positive()}),
      {"blood.haematocrit", &p.viscosity.haematocrit, "1", "0.45",
       "Discharge haematocrit: share of red cells in the blood that enters.", "",
       Range::between(0.001, 0.95)},
      only_with({"blood.viscosity_law", {"\"in_vitro\"", "\"in_vivo\""}},
                {"blood.least_diameter", &p.viscosity.least_diameter, "m", "\"2 um\"",
                 "A vessel narrower than this has the viscosity of this diameter: the laws were not measured "
                 "below 3 "
                 "um, and the "
                 "one in vivo is infinite at 1.1 um.",
                 "", Range{.lower = 1.15e-6, .upper = 1e-5}}),
      {"blood.density", &p.density, "kg/m3", "\"1060 kg/m3\"",
       "Of blood, for the pressure of its weight, Reynolds numbers and a coupled vessel's leak.", "Eq. (7)",
       Range::positive()},
      {"blood.phase_separation", &p.phase_separation, "", "false",
       "Explicit networks: red cells divide unevenly at bifurcations, so that every vessel has its own "
       "haematocrit.",
       "Pries & Secomb 2008"},
      only_with({"blood.phase_separation", {"true"}},
                {"blood.phase_tolerance", &p.phase_tolerance, "1", "1e-8",
                 "Stop when no vessel's haematocrit changes more in an iteration.", "",
                 Range::between(1e-14, 0.1)}),
      only_with({"blood.phase_separation", {"true"}},
                {"blood.phase_iterations", &p.phase_iterations, "1", "200", "The most iterations.", "",
                 Range::at_least(1)}),

      {"flow.inlet_pressure", &p.inlet_pressure, "Pa", "\"auto\"",
       "Pressure where blood enters a tree, relative to atmosphere. Of it, outlet_pressure and inlet_flow "
       "give two.",
       "Sec. 3.3"},
      {"flow.outlet_pressure", &p.outlet_pressure, "Pa", "\"auto\"", "Pressure where blood leaves a tree.",
       "Sec. 3.3"},
      {"flow.inlet_flow", &p.inlet_flow, "m3/s", "\"auto\"", "Flow into a tree.", "Sec. 3.3",
       Range::positive()},
      {"flow.acceleration", &p.acceleration, "m/s2", "[]",
       "Gravity, or the body's acceleration, as three components: adds the weight of the blood to pressures "
       "(hydrostatic term).",
       "Eq. (7)"},
  };
}

void resolve(Parameters& p) {
  p.viscosity.law = p.viscosity_law == "constant"   ? ViscosityLaw::constant
                    : p.viscosity_law == "in_vitro" ? ViscosityLaw::in_vitro
                                                    : ViscosityLaw::in_vivo;
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
