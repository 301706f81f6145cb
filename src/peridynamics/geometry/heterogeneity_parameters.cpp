#include "peridynamics/geometry/heterogeneity_parameters.hpp"

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::peridynamics {

ParameterList declare(Scatter& s) {
  const std::vector<Condition> something_scatters{{"scatter.critical_stretch", {}},
                                                  {"scatter.stiffness", {}}};
  return {
      only_with_one_of(something_scatters,
                       {"scatter.law",
                        &s.law,
                        "",
                        "\"lognormal\"",
                        "Distribution, over the wall, of the factors of mean 1 by which properties scatter.",
                        "",
                        {},
                        {"lognormal", "weibull"}}),
      {"scatter.critical_stretch", &s.critical_stretch, "1", "0",
       "Scatter of the critical stretch: coefficient of variation of its factor; 0 for none.", "",
       Range::between(0, 1)},
      {"scatter.stiffness", &s.stiffness, "1", "0",
       "The same of the stiffness, whose factor is independent of the critical stretch's.", "",
       Range::between(0, 1)},
      only_with_one_of(something_scatters,
                       {"scatter.correlation_length", &s.correlation_length, "m", "\"auto\"",
                        "Distance at which the correlation of a factor (before it is made lognormal or "
                        "Weibull) has fallen "
                        "to 1/e; \"auto\" is half of the wall's thickness.",
                        "", Range::positive()}),
      only_with_one_of(something_scatters, {"scatter.seed", &s.seed, "1", "1",
                                            "Which wall is drawn: a function of the seed and the place "
                                            "alone, whatever the resolution. Wall i of "
                                            "an ensemble takes seed + i.",
                                            "", Range::at_least(0)}),
  };
}

double Spots::nearness(std::size_t i, double mid_radius, double around, double z) const {
  const double along_circle = mid_radius * std::remainder(around - angle[i], 2 * std::numbers::pi);
  const double along_axis = std::remainder(z - position[i], period);
  const double distance = std::hypot(along_axis, along_circle) / radius[i];
  return distance < 1 ? 0.5 * (1 + std::cos(std::numbers::pi * distance)) : 0.0;
}

ParameterList declare(Spots& s) {
  return {
      {"spot.position",
       &s.position,
       "m",
       {},
       "Centre of the spot along the axis, from the vessel's end.",
       "",
       Range::not_negative(),
       {},
       true},
      {"spot.angle",
       &s.angle,
       "rad",
       "\"0 deg\"",
       "Centre of the spot around the axis, from the x axis towards the y axis.",
       "",
       Range::any(),
       {},
       true},
      {"spot.radius",
       &s.radius,
       "m",
       {},
       "Radius of the spot, along the wall at its mid-radius; factors go over to 1 from its centre to its "
       "edge "
       "as 1 + (factor - 1) (1 + cos(pi d / radius)) / 2.",
       "",
       Range::positive(),
       {},
       true},
      {"spot.critical_stretch",
       &s.critical_stretch,
       "1",
       "1",
       "Critical stretch at the centre over that of the wall around it.",
       "",
       Range::positive(),
       {},
       true},
      {"spot.stiffness",
       &s.stiffness,
       "1",
       "1",
       "Stiffness at the centre over that of the wall around it.",
       "",
       Range::positive(),
       {},
       true},
      {"spot.thickness",
       &s.thickness,
       "1",
       "1",
       "Thickness at the centre over that of the wall around it: the outer part is missing there.",
       "",
       {.lower = 0, .upper = 1, .lower_open = true},
       {},
       true},
  };
}

std::vector<std::string> resolve(Scatter& s, double wall, double spacing) {
  if (!s.correlation_length) s.correlation_length = 0.5 * wall;
  if (s.none()) return {};
  const double in_spacings = *s.correlation_length / spacing;
  if (in_spacings < 0.1) {
    throw InputError("at least a tenth of the spacing is needed, " + quantity(0.1 * spacing, "m"),
                     "scatter.correlation_length");
  }
  if (in_spacings < 2) {
    return {"the scatter's correlation length (" + quantity(*s.correlation_length, "m") + ") is " +
            text(in_spacings) + " spacings; below 2 it is not resolved, and results depend on the spacing"};
  }
  return {};
}

std::vector<std::string> check(const Spots& s, double length, double wall, double spacing) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const std::string spot = "spot[" + std::to_string(i + 1) + "]";
    if (s.position[i] > length)
      throw InputError("beyond the vessel's end, " + quantity(length, "m"), spot + ".position");
    if (s.thickness[i] * wall < spacing * (1 - 1e-9)) {
      throw InputError("leaves " + quantity(s.thickness[i] * wall, "m") + " of the wall; one spacing, " +
                           quantity(spacing, "m") + ", is the least",
                       spot + ".thickness");
    }
    if (s.critical_stretch[i] == 1 && s.stiffness[i] == 1 && s.thickness[i] == 1)
      warnings.push_back(spot + " changes nothing: give its critical_stretch, stiffness or thickness");
    if (s.radius[i] < 2 * spacing) {
      warnings.push_back(spot + " has a radius of " + quantity(s.radius[i], "m") +
                         "; below 2 spacings it is not resolved");
    }
  }
  return warnings;
}

}  // namespace rhexis::peridynamics
