// SPDX-License-Identifier: BSD-3-Clause
/// Compressible neo-Hookean solid: rubber-like, any Poisson's ratio below 1/2.
///
///   W = mu/2 (I1 - 3 - 2 ln J) + lambda/4 (J^2 - 1 - 2 ln J),   I1 = tr F^T F,  J = det F,
///   P = dW/dF = mu (F - F^-T) + lambda/2 (J^2 - 1) F^-T,
///
/// which is Hooke's law of E and nu where strains are small, and bears any compression (Ciarlet & Geymonat
/// 1982; Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2008, Sec. 6.4).
///
///   [material]
///   law = "neo_hookean"
///   poisson_ratio = 0.49
#pragma once

#include <cmath>

#include "peridynamics/laws/correspondence/tensor.hpp"
#include "peridynamics/laws/law_parameters.hpp"

namespace rhexis::peridynamics {

struct NeoHookean {
  static constexpr std::string_view name = "neo_hookean";
  static constexpr std::string_view meaning =
      "neo-Hookean solid, by its deformation gradient: any Poisson's ratio";
  static constexpr std::string_view source = "Bonet & Wood 2008";

  double shear_modulus = 0;  ///< Pa, the unit of stress
  double lame = 0;           ///< lambda / mu

  NeoHookean(double young_modulus, double poisson_ratio)
      : shear_modulus(young_modulus / (2 * (1 + poisson_ratio))),
        lame(2 * poisson_ratio / (1 - 2 * poisson_ratio)) {}

  /// First Piola-Kirchhoff stress P, in units of mu.
  template <Number X>
  HWY_INLINE Tensor<X> stress(const Deformation<X>& f) const {
    const Tensor<X>&h = f.gradient, &c = f.cofactor_of_gradient;
    const X inverse = X(1) / f.volume_ratio(), j = f.dilation, t = trace(h);
    const Tensor<X> a = f.area_map();
    const X of_volume = X(0.5 * lame) * j * (j + X(2));
    // mu (F - F^-T) J = (J - 1) F + H + H^T - tr H - cof H, without cancellation.
    const auto diagonal = [&](X hii, X cii, X aii) {
      return inverse * (j * (hii + X(1)) + hii + hii - t - cii + of_volume * aii);
    };
    const auto other = [&](X hij, X hji, X cij, X aij) {
      return inverse * (j * hij + hij + hji - cij + of_volume * aij);
    };
    return {diagonal(h.xx, c.xx, a.xx),    other(h.xy, h.yx, c.xy, a.xy), other(h.xz, h.zx, c.xz, a.xz),
            other(h.yx, h.xy, c.yx, a.yx), diagonal(h.yy, c.yy, a.yy),    other(h.yz, h.zy, c.yz, a.yz),
            other(h.zx, h.xz, c.zx, a.zx), other(h.zy, h.yz, c.zy, a.zy), diagonal(h.zz, c.zz, a.zz)};
  }

  /// W, in units of mu.
  double energy(const Deformation<double>& f) const {
    const double j = f.dilation, log_j = std::log1p(j);
    return 0.5 * (f.first_invariant() - 2 * log_j) + 0.25 * lame * (j * (j + 2) - 2 * log_j);
  }
};

}  // namespace rhexis::peridynamics
