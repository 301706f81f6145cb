// SPDX-License-Identifier: BSD-3-Clause
/// Where a particle is in a wall, for laws and stresses that have directions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace rhexis::peridynamics {

/// At rest; directions are unit vectors.
struct WallFrame {
  std::array<float, 3> radial;  ///< across the wall, away from the lumen
  std::array<float, 3> axial;   ///< along the vessel
  float depth;                  ///< 0 at the lumen, 1 at the outer surface

  /// Along the wall, `angle` (rad) from the circumference towards the axis.
  std::array<double, 3> along_wall(double angle) const {
    std::array<double, 3> direction{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      const double hoop = double{axial[l]} * double{radial[m]} - double{axial[m]} * double{radial[l]};
      direction[k] = std::cos(angle) * hoop + std::sin(angle) * double{axial[k]};
    }
    return direction;
  }
};

}  // namespace rhexis::peridynamics
