// SPDX-License-Identifier: BSD-3-Clause
/// The weight of blood, P_g of Eq. (7): in a body that is accelerated (or at rest under gravity) by a, blood
/// at rest has the pressure rho a . x. Steady flow through rigid vessels is driven by the rest, P* = P - rho
/// a . x alone, so the flow solvers know nothing of it: conditions are turned into P* before, and pressures
/// back after.
#pragma once

#include <array>

namespace rhexis::hemodynamics {

struct Hydrostatic {
  double density = 0;                    ///< kg/m3
  std::array<double, 3> acceleration{};  ///< m/s2; gravity points down, e.g. (0, 0, -9.81)

  bool acts() const { return acceleration[0] != 0 || acceleration[1] != 0 || acceleration[2] != 0; }
  /// P_g at a point (m), Pa; Eq. (7).
  double pressure(double x, double y, double z) const {
    return density * (acceleration[0] * x + acceleration[1] * y + acceleration[2] * z);
  }
};

}  // namespace rhexis::hemodynamics
