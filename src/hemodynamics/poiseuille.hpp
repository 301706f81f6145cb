// SPDX-License-Identifier: BSD-3-Clause
/// Laminar flow through a rigid cylinder: Q = dP / R with R = 8 eta L / (pi r0^4)   (Eq. 9, Sec. 3.3).
///
/// eta: apparent viscosity, Pa s; L: axial length, m; r0: radius of the lumen, m; Q: m3/s; dP: Pa.
#pragma once

#include <numbers>

namespace rhexis::hemodynamics {

/// Resistance in Pa s/m3, Eq. (9).
template <class Real>
constexpr Real poiseuille_resistance(Real radius, Real length, Real viscosity) {
  const Real square = radius * radius;
  return 8 * viscosity * length / (std::numbers::pi_v<Real> * square * square);
}

/// Shear stress of the blood on the wall, Pa: 4 eta Q / (pi r0^3), from Eq. (9) and the balance of forces.
template <class Real>
constexpr Real wall_shear_stress(Real radius, Real viscosity, Real flow) {
  return 4 * viscosity * flow / (std::numbers::pi_v<Real> * radius * radius * radius);
}

/// Re = 2 rho |Q| / (pi r0 eta), of diameter and mean velocity; density rho in kg/m3.
template <class Real>
constexpr Real reynolds_number(Real radius, Real viscosity, Real flow, Real density) {
  return 2 * density * (flow < 0 ? -flow : flow) / (std::numbers::pi_v<Real> * radius * viscosity);
}

/// Above it flow in a pipe is not laminar, and Eq. (9) gives too low a resistance.
inline constexpr double laminar_reynolds_number = 2300;

}  // namespace rhexis::hemodynamics
