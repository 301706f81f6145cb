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

#include <hwy/contrib/math/math-inl.h>

#include <cmath>

#include "peridynamics/laws/pmb.hpp"

namespace rhexis::peridynamics {

struct Fung {
  static constexpr bool state_based = false;
  double exponent;  ///< a > 0

  static double bond_constant(double young_modulus, double horizon) {
    return Pmb::bond_constant(young_modulus, horizon);
  }
  static double breaking_t(double critical_stretch) { return Pmb::breaking_t(critical_stretch); }
  template <class D, class V>
  static HWY_INLINE V breaking_t(D d, V critical_stretch) {
    return Pmb::breaking_t(d, critical_stretch);
  }

  /// Energy of a bond of stretch s, relative to PMB's.
  double energy_ratio(double s) const {
    const double q = exponent * s * s;
    return std::expm1(q) / q;
  }

  /// G0 (J/m2): PMB's times what breaking any bond takes more (Pmb::energy_release_rate).
  double energy_release_rate(double young_modulus, double horizon, double critical_stretch) const {
    return Pmb::energy_release_rate(young_modulus, horizon, critical_stretch) *
           energy_ratio(critical_stretch);
  }

  /// s0 from G0: with s of PMB, exp(a s0^2) - 1 = a s^2.
  double critical_stretch(double young_modulus, double horizon, double energy_release_rate) const {
    const double s = Pmb::critical_stretch(young_modulus, horizon, energy_release_rate);
    return std::sqrt(std::log1p(exponent * s * s) / exponent);
  }

  /// Largest stiffness df/ds of a bond within -s..s, relative to c: what the stable time step depends on.
  double stiffness_ratio(double s) const {
    const double q = exponent * s * s;
    return (1 + 2 * q) * std::exp(q);
  }

  /// exp(a s^2) s / (1 + s), as Pmb::force_factor.
  template <class D, class V>
  HWY_INLINE V force_factor(D d, V t) const {
    namespace hn = hwy::HWY_NAMESPACE;
    const V g = Pmb::force_factor(d, t);
    return hn::Mul(g, hn::Exp(d, quadratic(d, Pmb::stretch(d, t, g))));
  }

  /// (exp(a s^2) - 1) / (2 a), as Pmb::energy_factor.
  template <class D, class V>
  HWY_INLINE V energy_factor(D d, V t) const {
    namespace hn = hwy::HWY_NAMESPACE;
    using Real = hn::TFromD<D>;
    const V q = quadratic(d, Pmb::stretch(d, t, Pmb::force_factor(d, t)));
    return hn::Mul(hn::Expm1(d, q), hn::Set(d, static_cast<Real>(0.5 / exponent)));
  }

 private:
  template <class D, class V>
  HWY_INLINE V quadratic(D d, V s) const {
    namespace hn = hwy::HWY_NAMESPACE;
    return hn::Mul(hn::Mul(s, s), hn::Set(d, static_cast<hn::TFromD<D>>(exponent)));
  }
};

}  // namespace rhexis::peridynamics
