// SPDX-License-Identifier: BSD-3-Clause
/// Linear peridynamic solid (LPS): ordinary, state-based, any Poisson's ratio; Silling et al. 2007, J. Elast.
/// 88, 151-184.
///
/// With extensions e = |xi + eta| - |xi|, influence function omega and weighted volume m = int omega |xi|^2
/// dV, a particle's dilatation and the scalar force state of its bonds are
///
///   theta = 3/m int omega |xi| e dV,    t = (3K - 5G) theta/m omega |xi| + 15G/m omega e,
///
/// the derivative of W = 1/2 (K - 5G/3) theta^2 + 15G/(2m) int omega e^2 dV, and the pairwise force density
/// is t_i + t_j along the bond. Here omega = w/|xi|, w the bond's weight (surface_correction.hpp), so that
/// omega |xi| is w and omega e is w times the stretch s, and m is the whole ball's for w = 1, pi delta^4,
/// everywhere. With c = 30 G / (pi delta^4) what is left is
///
///   f = c w (p_i + p_j + s),    p = kappa theta / 2,    kappa = (3K - 5G) / (15G):
///
/// PMB and a pressure; at nu = 1/4, where kappa is 0, PMB to the last bit. p_i + p_j is the same number at
/// both ends of a bond.
///
/// Particles at surfaces, whose families are not whole, could have their own m instead; the wall of 5
/// spacings is then 18 to 35 % too stiff against Lame, and without 7 to 13 % off. Calibrated weights leave
/// 0.7 to 6 % (lps_lame_test.cpp): what they make of the energies of bonds, of which sum w |xi| V is the
/// trace, they make of dilatations too.
///
/// Bonds break by Eq. (5). A broken bond leaves theta and the forces, not m: with m the bonds that are left
/// would become the stiffer the fewer they are, and the stable time step would shrink. It takes c s0^2 |xi| /
/// 2 as PMB's does, and what the energy of theta falls by at both ends - which near nu = 1/2 can be negative:
/// theta loses the stretched bonds first, and looks compressed. That fall is taken at the step that finds the
/// bond broken, somewhat late: while a wall is torn to shreds the energy balance is of first order in the
/// step.
///
///   [material]
///   law = "lps"
///   poisson_ratio = 0.45
#pragma once

#include <numbers>

#include "peridynamics/laws/pmb.hpp"

namespace rhexis::peridynamics {

struct Lps : Pmb {
  static constexpr std::string_view name = "lps";
  static constexpr std::string_view meaning = "linear peridynamic solid: state-based, any Poisson's ratio";
  static constexpr std::string_view source = "Silling 2007";
  static constexpr bool state_based = true;

  double nu;  ///< Poisson's ratio

  explicit Lps(double ratio) : nu(ratio) {}
  explicit Lps(const LawChoice& choice) : Lps(choice.poisson_ratio) {}

  /// m of a whole family.
  static double weighted_volume(double horizon) {
    return std::numbers::pi * horizon * horizon * horizon * horizon;
  }

  /// c = 30 G / (pi delta^4), N/m6.
  double bond_constant(double young_modulus, double horizon) const {
    return 15 * young_modulus / ((1 + nu) * weighted_volume(horizon));
  }

  double kappa() const { return (4 * nu - 1) / (5 * (1 - 2 * nu)); }

  /// 1/2 (K - 5G/3) theta^2, relative to c m.
  double dilatation_energy(double theta) const { return kappa() / 12 * theta * theta; }
};

}  // namespace rhexis::peridynamics
