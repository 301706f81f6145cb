// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/laws/strength.hpp"

#include <utility>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/laws/all_laws.hpp"

namespace rhexis::peridynamics {

namespace {

void resolve_from_rate(Parameters& p) {
  if (p.critical_stretch) {
    throw InputError("give either material.critical_stretch or material.energy_release_rate, not both",
                     "material.energy_release_rate");
  }
  if (p.law.by_gradient())
    throw InputError("not for material.law = \"" + p.law.name + "\"; give material.critical_stretch",
                     "material.energy_release_rate");
  const double rate = *std::exchange(p.energy_release_rate, std::nullopt);
  const double stretch = with_law(p.law, [&]<class Law>(const Law& law) -> double {
    if constexpr (Law::state_based) {
      throw InputError("not for material.law = \"" + p.law.name +
                           "\", whose energy of dilatation breaks with the bonds; give "
                           "material.critical_stretch",
                       "material.energy_release_rate");
    } else {
      return law.critical_stretch(p.young_modulus, *p.horizon, rate);
    }
  });
  if (stretch < 1e-6 || stretch > 10) {
    throw InputError("at a horizon of " + quantity(*p.horizon, "m") + " bonds would break at a stretch of " +
                         text(stretch) + "; 1e-6 to 10 is allowed",
                     "material.energy_release_rate");
  }
  p.critical_stretch = stretch;
}

}  // namespace

void resolve_critical_stretch(Parameters& p) {
  constexpr double paper_stretch = 0.25;
  resolve(p.law);
  if (p.energy_release_rate) resolve_from_rate(p);
  if (!p.critical_stretch) p.critical_stretch = paper_stretch;
  check_hardening(p.law, *p.critical_stretch);
}

std::string describe_strength(const Parameters& p) {
  const std::string stretch = "critical stretch " + text(*p.critical_stretch);
  if (p.law.by_gradient()) return stretch;
  return with_law(p.law, [&]<class Law>(const Law& law) {
    if constexpr (Law::state_based) return stretch;
    const double rate = law.energy_release_rate(p.young_modulus, *p.horizon, *p.critical_stretch);
    return stretch + ", energy release rate " + quantity(rate, "J/m2");
  });
}

}  // namespace rhexis::peridynamics
