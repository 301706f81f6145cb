// SPDX-License-Identifier: BSD-3-Clause
/// What presses on a vessel's wall.
#pragma once

#include <array>
#include <limits>

namespace rhexis::coupling {

/// The parts of Eq. (7) at one place of the body, Pa. All but P_g and P_t are relative to the atmosphere to
/// which the pressures of the network are relative.
struct PressureParts {
  double heart = 0;         ///< P_heart, of the flow through the network
  double acceleration = 0;  ///< P_g, weight of blood (hemodynamics/hydrostatic.hpp)
  double tension = 0;       ///< P_t, of the tissue around the vessel
  double atmosphere = 0;    ///< P_atm
  double compression = 0;   ///< P_comp, of a cuff or g-suit

  /// P_t + P_atm + P_comp - P_g: what P_heart has to overcome, and where a leak flows to.
  double outside() const { return tension + atmosphere + compression - acceleration; }
};

/// P_net, Pa: Eq. (7), Sec. 3.2.
inline double net_pressure(const PressureParts& p) {
  return p.heart + p.acceleration - p.tension - p.atmosphere - p.compression;
}

/// Compression of the slab of the body between two planes across an axis; by default of all of it.
struct Compression {
  double pressure = 0;  ///< Pa
  int axis = 0;         ///< 0, 1, 2: x, y, z
  double from = -std::numeric_limits<double>::infinity(),
         to = std::numeric_limits<double>::infinity();  ///< m

  double at(const std::array<double, 3>& position) const {
    const double x = position[static_cast<std::size_t>(axis)];
    return x >= from && x <= to ? pressure : 0;
  }
};

}  // namespace rhexis::coupling
