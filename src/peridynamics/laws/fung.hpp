// SPDX-License-Identifier: BSD-3-Clause
/// A bond that stiffens exponentially, as collagen does when its fibres straighten.
///
/// Fung's strain energy of soft tissue grows like exp(Q), Q quadratic in the strain (Fung, Fronek & Patitucci
/// 1979); Sun, Yin, Zhang & Liew 2023 (J. Mech. Phys. Solids 174, 105274) took such a material into
/// bond-based peridynamics to tear blood vessels. Here every bond has a Fung energy of its own stretch s,
///
///   w = c |xi| / (2 a) (exp(a s^2) - 1),     f = dw/d|xi + eta| = c s exp(a s^2) (xi + eta)/|xi + eta|,
///
/// which is PMB with the same c where a s^2 is small, so that E keeps its meaning, and Poisson's ratio is 1/4
/// there. (The form is ours: it is the simplest of the kind, not taken from the paper of 2023.) Bonds break
/// as PMB's do, Eq. (5).
///
///   [material]
///   law = "fung"
///   fung_exponent = 10
#pragma once

#include <cmath>

#include "peridynamics/laws/pmb.hpp"

namespace rhexis::peridynamics {

struct Fung : Pmb {
  static constexpr std::string_view name = "fung";
  static constexpr std::string_view meaning = "stiffening as collagen does, exp(a s^2) times as strong";
  static constexpr std::string_view source = "Fung 1979";
  static constexpr std::array numbers = {LawNumber{"fung_exponent",
                                                   "The exponent a",
                                                   "an exponent, such as 10",
                                                   {.lower = 0, .upper = 50, .lower_open = true}}};

  double exponent;  ///< a > 0

  explicit Fung(double a) : exponent(a) {}
  explicit Fung(const LawChoice& choice) : Fung(choice.number("fung_exponent")) {}

  /// exp(a s^2) s / (1 + s).
  template <Number X>
  HWY_INLINE X force_factor(X t) const {
    const X g = stretch_over_length(t), s = stretch(t, g);
    return g * exp(s * s * X(exponent));
  }

  /// (exp(a s^2) - 1) / (2 a).
  template <Number X>
  HWY_INLINE X energy_factor(X t) const {
    const X s = stretch(t);
    return expm1(s * s * X(exponent)) * X(0.5 / exponent);
  }

  /// Logarithm of how many times as hard as a linear one a bond pulls.
  double hardening(double s) const { return exponent * s * s; }

  double energy_ratio(double s) const {
    const double q = exponent * s * s;
    return std::expm1(q) / q;
  }

  double stiffness_ratio(double s) const {
    const double q = exponent * s * s;
    return (1 + 2 * q) * std::exp(q);
  }

  /// G0 (J/m2): PMB's times what breaking any bond takes more.
  double energy_release_rate(double young_modulus, double horizon, double critical_stretch) const {
    return Pmb::energy_release_rate(young_modulus, horizon, critical_stretch) *
           energy_ratio(critical_stretch);
  }

  /// s0 from G0: with s of PMB, exp(a s0^2) - 1 = a s^2.
  double critical_stretch(double young_modulus, double horizon, double energy_release_rate) const {
    const double s = Pmb::critical_stretch(young_modulus, horizon, energy_release_rate);
    return std::sqrt(std::log1p(exponent * s * s) / exponent);
  }
};

}  // namespace rhexis::peridynamics
