#include "peridynamics/heterogeneity_parameters.hpp"

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::peridynamics {

ParameterList declare(Scatter& s) {
  return {
      {"scatter.law",
       &s.law,
       "",
       "\"lognormal\"",
       "Distribution, over the wall, of the factors of mean 1 by which properties scatter.",
       "",
       {},
       {"lognormal", "weibull"}},
      {"scatter.critical_stretch", &s.critical_stretch, "1", "0",
       "Scatter of the critical stretch: coefficient of variation of its factor; 0 for none.", "",
       Range::between(0, 1)},
      {"scatter.stiffness", &s.stiffness, "1", "0",
       "The same of the stiffness, whose factor is independent of the critical stretch's.", "",
       Range::between(0, 1)},
      {"scatter.correlation_length", &s.correlation_length, "m", "\"auto\"",
       "Distance at which the correlation of a factor (before it is made lognormal or Weibull) has fallen "
       "to 1/e; \"auto\" is half of the wall's thickness.",
       "", Range::positive()},
      {"scatter.seed", &s.seed, "1", "1",
       "Which wall is drawn: a function of the seed and the place alone, whatever the resolution. Wall i of "
       "an "
       "ensemble takes seed + i.",
       "", Range::at_least(0)},
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

}  // namespace rhexis::peridynamics
