// SPDX-License-Identifier: BSD-3-Clause
/// Blood that leaves a vessel through an opening in its wall.
#pragma once

#include "hemodynamics/steady/vessel_in_network.hpp"

namespace rhexis::hemodynamics {

/// The orifice law Q = Cd A sqrt(2 (P - P_outside) / rho), as Q = strength sqrt(P - P_outside).
struct Orifice {
  double strength = 0;          ///< Cd A sqrt(2 / rho), m3/(s sqrt(Pa))
  double outside_pressure = 0;  ///< Pa
};

/// The flow of the network around a vessel that leaks through `orifice`. Seen from the leak, the network is
/// one pressure P_0 (without leak) behind one resistance R (Thevenin), so that P_0 - R Q = P with the law
/// above is a quadratic equation; no iteration. Nothing flows where P_0 is not above the pressure outside.
VesselState bleed(const VesselInNetwork& network, double resistance_factor, const Orifice& orifice);

/// The leak of that equation: drive = P_0 - P_outside (Pa), resistance R (Pa s/m3); m3/s.
double orifice_leak(double drive, double resistance, double strength);

}  // namespace rhexis::hemodynamics
