// SPDX-License-Identifier: BSD-3-Clause
/// Thickness of a vessel's wall, and the stress that a pressure causes in it.
#pragma once

#include <cmath>

#include "core/enum_names.hpp"

namespace rhexis::network {

/// How thick walls are. `ratio`: h = ratio r0. `radius`: h / r0 = 0.2802 exp(-505.3 r0) + 0.1324 exp(-11.14
/// r0), r0 in m: a fit to arteries of all calibres (Blanco et al. 2015; as in Boileau et al. 2015,
/// doi:10.1002/cnm.2732).
enum class WallRule { ratio, radius };

constexpr auto name_table(WallRule) {
  using enum WallRule;
  return std::to_array<Named<WallRule>>({{ratio, "ratio"}, {radius, "radius"}});
}

struct Wall {
  WallRule rule = WallRule::ratio;
  double ratio = 1.0 / 3.0;

  /// h / r0 of a lumen of `radius` (m).
  template <class Real>
  Real relative_thickness(Real radius) const {
    if (rule == WallRule::ratio) return Real(ratio);
    return Real(0.2802L) * std::exp(Real(-505.3L) * radius) +
           Real(0.1324L) * std::exp(Real(-11.14L) * radius);
  }
};

/// Hoop stress at the lumen over the transmural pressure, after Lame: (r1^2 + r0^2) / (r1^2 - r0^2), with
/// r1 = r0 (1 + h/r0).
template <class Real>
constexpr Real lumen_stress_factor(Real relative_thickness) {
  const Real square = (1 + relative_thickness) * (1 + relative_thickness);
  return (square + 1) / (square - 1);
}

/// Hoop strain at the lumen, (sigma_theta + nu P) / E: plane stress, with the radial stress -P (Lame).
template <class Real>
constexpr Real lumen_hoop_strain(Real pressure, Real relative_thickness, Real young_modulus,
                                 Real poisson_ratio) {
  return pressure * (lumen_stress_factor(relative_thickness) + poisson_ratio) / young_modulus;
}

}  // namespace rhexis::network
