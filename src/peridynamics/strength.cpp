#include "peridynamics/strength.hpp"

#include <utility>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/materials/pmb.hpp"

namespace rhexis::peridynamics {

void settle_critical_stretch(Parameters& p) {
  constexpr double paper_stretch = 0.25;
  if (!p.energy_release_rate) {
    p.critical_stretch = p.critical_stretch.value_or(paper_stretch);
    return;
  }
  if (p.critical_stretch) {
    throw InputError("give either material.critical_stretch or material.energy_release_rate, not both",
                     "material.energy_release_rate");
  }
  const double rate = *std::exchange(p.energy_release_rate, std::nullopt);
  const double stretch = Pmb::critical_stretch(p.young_modulus, *p.horizon, rate);
  if (stretch < 1e-6 || stretch > 10) {
    throw InputError("at a horizon of " + quantity(*p.horizon, "m") + " bonds would break at a stretch of " +
                         text(stretch) + "; 1e-6 to 10 is allowed",
                     "material.energy_release_rate");
  }
  p.critical_stretch = stretch;
}

std::string describe_strength(const Parameters& p) {
  const double rate = Pmb::energy_release_rate(p.young_modulus, *p.horizon, *p.critical_stretch);
  return "critical stretch " + text(*p.critical_stretch) + ", energy release rate " + quantity(rate, "J/m2");
}

}  // namespace rhexis::peridynamics
