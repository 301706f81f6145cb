// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/bleeding.hpp"

#include <cmath>

namespace rhexis::hemodynamics {

double orifice_leak(double drive, double resistance, double strength) {
  if (drive <= 0 || strength <= 0) return 0;
  // y = sqrt(P - P_outside): y^2 + R S y - drive = 0, without cancellation.
  const double half = resistance * strength / 2;
  return strength * drive / (half + std::sqrt(half * half + drive));
}

VesselState bleed(const VesselInNetwork& network, double resistance_factor, const Orifice& orifice) {
  const VesselState closed = network.solve(resistance_factor, 0, orifice.outside_pressure);
  const double drive = closed.pressure_middle - orifice.outside_pressure;
  if (drive <= 0 || orifice.strength <= 0) return closed;
  // Any leak tells the resistance; one as strong as without resistance is neither lost nor dominant.
  const VesselState probe =
      network.solve(resistance_factor, orifice.strength / std::sqrt(drive), orifice.outside_pressure);
  const double resistance = (closed.pressure_middle - probe.pressure_middle) / probe.leak;
  const double leak = orifice_leak(drive, resistance, orifice.strength);
  const double left = std::pow(leak / orifice.strength, 2);
  return network.solve(resistance_factor, leak / left, orifice.outside_pressure);
}

}  // namespace rhexis::hemodynamics
