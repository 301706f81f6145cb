// SPDX-License-Identifier: BSD-3-Clause
/// Apparent viscosity of blood in narrow vessels (Fahraeus-Lindqvist effect), relative to plasma.
///
/// With the lumen's diameter D in um and the discharge haematocrit H:
///   n(D, H) = 1 + (n45(D) - 1) F(D, H),   F = ((1 - H)^C - 1) / ((1 - 0.45)^C - 1)
///   C = (0.8 + exp(-0.075 D)) (t - 1) + t,   t = 1 / (1 + 1e-11 D^12)
/// in vitro:  n45 = 220 exp(-1.3 D) + 3.2 - 2.44 exp(-0.06 D^0.645)
///   (Pries, Neuhaus, Gaehtgens 1992, Am J Physiol 263:H1770, doi:10.1152/ajpheart.1992.263.6.H1770)
/// in vivo:   n45 = 6 exp(-0.085 D) + 3.2 - 2.44 exp(-0.06 D^0.645),  n = (1 + (n45 - 1) F W) W,
///   W = (D / (D - 1.1))^2, infinite at D = 1.1 um
///   (Pries, Secomb, Gessner et al. 1994, Circ Res 75:904, doi:10.1161/01.RES.75.5.904)
///
/// Red cells of other species are of another size: D is the lumen's diameter times the cube root of 92 fl
/// over the mean cell volume; 92 fl is that of man, about 55 fl that of rats (as in Secomb's program
/// NetFlow).
///
/// Neither law was measured below about 3 um. Where D is below `least_diameter`, the value there is taken.
#pragma once

#include <cmath>

#include "core/enum_names.hpp"

namespace rhexis::hemodynamics {

enum class ViscosityLaw { constant, in_vitro, in_vivo };

constexpr auto name_table(ViscosityLaw) {
  using enum ViscosityLaw;
  return std::to_array<Named<ViscosityLaw>>(
      {{constant, "constant"}, {in_vitro, "in_vitro"}, {in_vivo, "in_vivo"}});
}

inline constexpr double human_cell_volume = 92e-18;  ///< m3, of the red cells that the laws were fitted to

struct Viscosity {
  ViscosityLaw law = ViscosityLaw::constant;
  double constant = 3.5e-3;                     ///< Pa s, of the constant law
  double plasma = 1.0466e-3;                    ///< Pa s
  double haematocrit = 0.45;                    ///< H, where no other is given
  double least_diameter = 2e-6;                 ///< m, above 1.1 um
  double mean_cell_volume = human_cell_volume;  ///< m3, of the red cells

  /// D over the diameter of the lumen.
  double diameter_scale() const {
    return mean_cell_volume == human_cell_volume ? 1 : std::cbrt(human_cell_volume / mean_cell_volume);
  }
  /// The lumen's radius (m) where D is `least_diameter`.
  double least_radius() const { return least_diameter / 2 / diameter_scale(); }
};

/// n(D, H) of a law that depends on the diameter; D in um.
template <class Real>
Real relative_viscosity(ViscosityLaw law, Real diameter_um, Real haematocrit) {
  using std::exp, std::expm1, std::log1p, std::log, std::pow;
  const Real d = diameter_um;
  const Real d4 = d * d * d * d;
  // (t - 1) and t without cancellation.
  const Real power = Real(1e-11L) * d4 * d4 * d4;
  const Real t = 1 / (1 + power);
  const Real c = -(Real(0.8L) + exp(Real(-0.075L) * d)) * power * t + t;
  const Real f = expm1(c * log1p(-haematocrit)) / expm1(c * log1p(Real(-0.45L)));
  const Real common = Real(3.2L) - Real(2.44L) * exp(Real(-0.06L) * pow(d, Real(0.645L)));
  if (law == ViscosityLaw::in_vitro) return 1 + (220 * exp(Real(-1.3L) * d) + common - 1) * f;
  const Real ratio = d / (d - Real(1.1L));
  const Real w = ratio * ratio;
  return (1 + (6 * exp(Real(-0.085L) * d) + common - 1) * f * w) * w;
}

/// Apparent viscosity, Pa s, in a lumen of `radius` (m).
template <class Real>
Real apparent_viscosity(const Viscosity& v, Real radius, Real haematocrit) {
  if (v.law == ViscosityLaw::constant) return Real(v.constant);
  const Real diameter = std::fmax(2 * radius * Real(v.diameter_scale()), Real(v.least_diameter));
  return Real(v.plasma) * relative_viscosity(v.law, diameter * Real(1e6L), haematocrit);
}

}  // namespace rhexis::hemodynamics
