// SPDX-License-Identifier: BSD-3-Clause
/// Prototype microelastic brittle (PMB) law, Sec. 3.1, Eqs. (2)-(5); Silling & Askari 2005.
///
/// The pairwise force density of Eq. (2) is
///
///   f = c s (xi + eta)/|xi + eta| = (c / |xi|) g (xi + eta),   g = s / (1 + s),
///
/// the micropotential w = c |xi| s^2 / 2 (J/m6), and a bond breaks, Eq. (5), when s >= s0.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "peridynamics/laws/law_parameters.hpp"
#include "peridynamics/laws/stretch.hpp"

namespace rhexis::peridynamics {

struct Pmb {
  static constexpr std::string_view name = "pmb";
  static constexpr std::string_view meaning = "in proportion to their stretch s, the paper's";
  static constexpr std::string_view source = "Eq. (2)";
  static constexpr std::array<LawNumber, 0> numbers = {};
  static constexpr bool state_based = false;
  static constexpr double poisson_ratio = 0.25;

  Pmb() = default;
  explicit Pmb(const LawChoice&) {}

  /// g(t): force over c (xi + eta) / |xi|.
  template <Number X>
  static HWY_INLINE X force_factor(X t) {
    return stretch_over_length(t);
  }

  /// Energy over c |xi|: s^2 / 2.
  template <Number X>
  static HWY_INLINE X energy_factor(X t) {
    const X s = stretch(t);
    return s * s * X(0.5);
  }

  /// Eq. (4): c = 6 E / (pi delta^4 (1 - 2 nu)) with nu = 1/4, N/m6; E in Pa, delta in m.
  static double bond_constant(double young_modulus, double horizon) {
    const double h2 = horizon * horizon;
    return 6 * young_modulus / (std::numbers::pi * h2 * h2 * (1 - 2 * poisson_ratio));
  }

  /// G0 (J/m2), the work to break all bonds across a unit of area (Silling & Askari 2005): of w = c s0^2 r/2
  /// a bond of length r, summed over depths z before the plane and caps of directions beyond it,
  ///   G0 = int_0^delta dz int_z^delta (c s0^2 r/2) 2 pi r^2 (1 - z/r) dr = pi c s0^2 delta^5 / 10;
  /// with Eq. (4) and nu = 1/4, c = 12 E / (pi delta^4), that is 6 E s0^2 delta / 5.
  static double energy_release_rate(double young_modulus, double horizon, double critical_stretch) {
    return bond_constant(young_modulus, horizon) * std::numbers::pi * critical_stretch * critical_stretch *
           std::pow(horizon, 5) / 10;
  }

  /// s0 of a wall that takes G0 to tear: sqrt(5 G0 / (6 E delta)).
  static double critical_stretch(double young_modulus, double horizon, double energy_release_rate) {
    return std::sqrt(5 * energy_release_rate / (6 * young_modulus * horizon));
  }

  /// Energy of a bond of stretch s relative to c |xi| s^2 / 2, which other laws may exceed.
  static double energy_ratio(double /*s*/) { return 1; }
  /// Largest stiffness df/ds of a bond within -s..s relative to c: what the stable time step depends on.
  static double stiffness_ratio(double /*s*/) { return 1; }
};

}  // namespace rhexis::peridynamics
