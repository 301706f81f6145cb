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

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include "peridynamics/geometry/wall_frame.hpp"
#include "peridynamics/laws/correspondence/tensor.hpp"

namespace rhexis::peridynamics {

/// P of a neo-Hookean solid, in units of mu; `lame` is lambda / mu.
template <Number X>
HWY_INLINE Tensor<X> neo_hookean_stress(const Deformation<X>& f, X lame) {
  const Tensor<X>&h = f.gradient, &c = f.cofactor_of_gradient;
  const X inverse = X(1) / f.volume_ratio(), j = f.dilation, t = trace(h);
  const Tensor<X> a = f.area_map();
  const X of_volume = X(0.5) * lame * j * (j + X(2));
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

/// W of a neo-Hookean solid, in units of mu; of one turned inside out, which only a particle is that is about
/// to be crushed, that at a thousandth of its volume.
inline double neo_hookean_energy(const Deformation<double>& f, double lame) {
  const double j = std::max(f.dilation, 1e-3 - 1), log_j = std::log1p(j);
  return 0.5 * (f.first_invariant() - 2 * log_j) + 0.25 * lame * (j * (j + 2) - 2 * log_j);
}

/// lambda / mu
inline double lame_ratio(double poisson_ratio) {
  return 2 * poisson_ratio / (1 - 2 * poisson_ratio);
}

struct NeoHookean {
  static constexpr std::string_view name = "neo_hookean";
  static constexpr std::string_view meaning =
      "neo-Hookean solid, by its deformation gradient: any Poisson's ratio";
  static constexpr std::string_view source = "Bonet & Wood 2008";

  double shear_modulus = 0;  ///< Pa, the unit of stress
  double lame = 0;           ///< lambda / mu

  NeoHookean(double young_modulus, double poisson_ratio)
      : shear_modulus(young_modulus / (2 * (1 + poisson_ratio))), lame(lame_ratio(poisson_ratio)) {}

  /// The law at the particles of a rank: it is the same everywhere.
  template <class Real>
  class AtParticles {
   public:
    AtParticles(const NeoHookean& law, const std::vector<const WallFrame*>& /*frames*/)
        : lame_(static_cast<Real>(law.lame)) {}

    /// See FibreReinforced.
    template <Number X>
    HWY_INLINE X shear_modulus(std::size_t /*i*/) const {
      return X(1);
    }
    template <Number X>
    HWY_INLINE Tensor<X> stress(const Deformation<X>& f, std::size_t /*i*/) const {
      return neo_hookean_stress(f, X(lame_));
    }
    double energy(const Deformation<double>& f, std::size_t /*i*/) const {
      return neo_hookean_energy(f, double{lame_});
    }
    double fibre_stretch(const Deformation<double>& /*f*/, std::size_t /*i*/) const { return 1; }

   private:
    Real lame_;
  };

  /// By how much it may stiffen up to a stretch: the largest tangent modulus over that at rest.
  double stiffening(double /*stretch*/) const { return 1; }
};

}  // namespace rhexis::peridynamics
