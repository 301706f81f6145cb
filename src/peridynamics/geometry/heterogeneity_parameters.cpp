// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/geometry/heterogeneity_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::peridynamics {

ParameterList declare(Scatter& s) {
  const std::vector<Condition> something_scatters{{"scatter.critical_stretch", {}},
                                                  {"scatter.stiffness", {}}};
  return {
      {.key = "scatter.law",
       .target = &s.law,
       .meaning = "Distribution, over the wall, of the factors of mean 1 by which properties scatter.",
       .only_with = something_scatters},
      {.key = "scatter.critical_stretch",
       .target = &s.critical_stretch,
       .unit = "1",
       .meaning = "Scatter of the critical stretch: coefficient of variation of its factor; 0 for none.",
       .range = Range::between(0, 1)},
      {.key = "scatter.stiffness",
       .target = &s.stiffness,
       .unit = "1",
       .meaning = "The same of the stiffness, whose factor is independent of the critical stretch's.",
       .range = Range::between(0, 1)},
      {.key = "scatter.correlation_length",
       .target = &s.correlation_length,
       .unit = "m",
       .meaning = "Distance at which the correlation of a factor (before it is made lognormal or Weibull) "
                  "has fallen to 1/e; \"auto\" is half of the wall's thickness.",
       .range = Range::positive(),
       .only_with = something_scatters},
      {.key = "scatter.seed",
       .target = &s.seed,
       .unit = "1",
       .meaning = "Which wall is drawn: a function of the seed and the place alone, whatever the resolution. "
                  "Wall i of an ensemble takes seed + i.",
       .range = Range::at_least(0),
       .only_with = something_scatters},
  };
}

bool Spots::thin_the_wall() const {
  return std::ranges::any_of(list, [](const Spot& spot) { return spot.thickness < 1; });
}

double Spots::nearness(const Spot& spot, double mid_radius, double angle, double z) const {
  const double along_circle = mid_radius * std::remainder(angle - spot.angle, 2 * std::numbers::pi);
  const double along_axis = std::remainder(z - spot.position, period);
  const double distance = std::hypot(along_axis, along_circle) / spot.radius;
  return distance < 1 ? 0.5 * (1 + std::cos(std::numbers::pi * distance)) : 0.0;
}

ParameterList declare(Spots& s) {
  return {
      {.key = "spot.position",
       .target = ListTarget(&s.list, &Spot::position),
       .unit = "m",
       .meaning = "Centre of the spot along the axis, from the vessel's end.",
       .range = Range::not_negative(),
       .required = true},
      {.key = "spot.angle",
       .target = ListTarget(&s.list, &Spot::angle),
       .unit = "rad",
       .default_in = "deg",
       .meaning = "Centre of the spot around the axis, from the x axis towards the y axis."},
      {.key = "spot.radius",
       .target = ListTarget(&s.list, &Spot::radius),
       .unit = "m",
       .meaning = "Radius of the spot, along the wall at its mid-radius; factors go over to 1 from its "
                  "centre to its edge as 1 + (factor - 1) (1 + cos(pi d / radius)) / 2.",
       .range = Range::positive(),
       .required = true},
      {.key = "spot.critical_stretch",
       .target = ListTarget(&s.list, &Spot::critical_stretch),
       .unit = "1",
       .meaning = "Critical stretch at the centre over that of the wall around it.",
       .range = Range::positive()},
      {.key = "spot.stiffness",
       .target = ListTarget(&s.list, &Spot::stiffness),
       .unit = "1",
       .meaning = "Stiffness at the centre over that of the wall around it.",
       .range = Range::positive()},
      {.key = "spot.thickness",
       .target = ListTarget(&s.list, &Spot::thickness),
       .unit = "1",
       .meaning = "Thickness at the centre over that of the wall around it: the outer part is missing there.",
       .range = {.lower = 0, .upper = 1, .lower_open = true}},
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
  for (std::size_t i = 0; i < s.list.size(); ++i) {
    const Spot& spot = s.list[i];
    const std::string section = "spot[" + std::to_string(i + 1) + "]";
    if (spot.position > length)
      throw InputError("beyond the vessel's end, " + quantity(length, "m"), section + ".position");
    if (spot.thickness * wall < spacing * (1 - 1e-9)) {
      throw InputError("leaves " + quantity(spot.thickness * wall, "m") + " of the wall; one spacing, " +
                           quantity(spacing, "m") + ", is the least",
                       section + ".thickness");
    }
    if (spot.critical_stretch == 1 && spot.stiffness == 1 && spot.thickness == 1)
      warnings.push_back(section + " changes nothing: give its critical_stretch, stiffness or thickness");
    if (spot.radius < 2 * spacing) {
      warnings.push_back(section + " has a radius of " + quantity(spot.radius, "m") +
                         "; below 2 spacings it is not resolved");
    }
  }
  return warnings;
}

}  // namespace rhexis::peridynamics
