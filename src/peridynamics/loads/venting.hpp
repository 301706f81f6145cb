// SPDX-License-Identifier: BSD-3-Clause
/// What an opening does to the pressure in a vessel: the orifice law.
#pragma once

#include <algorithm>
#include <cmath>

namespace rhexis::peridynamics {

/// Share of the scheduled pressure left in a vessel that leaks: blood enters through `supply_area` and leaves
/// through `open_area`, both by the orifice law Q = Cd A sqrt(2 dP / rho); equal flows give
/// P / P_0 = 1 / (1 + (A_open / A_supply)^2).
inline double venting_factor(double open_area, double supply_area) {
  const double ratio = open_area / supply_area;
  return 1 / (1 + ratio * ratio);
}

/// Leak by the orifice law, m3/s: Cd A sqrt(2 P / rho), outside pressure zero.
inline double orifice_flow(double discharge_coefficient, double area, double pressure, double density) {
  return discharge_coefficient * area * std::sqrt(2 * std::max(pressure, 0.0) / density);
}

}  // namespace rhexis::peridynamics
