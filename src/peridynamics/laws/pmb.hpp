/// Prototype microelastic brittle (PMB) law, Sec. 3.1, Eqs. (2)-(5); Silling & Askari 2005.
///
/// With t = (|xi + eta|^2 - |xi|^2) / |xi|^2 = (1 + s)^2 - 1, computed by the caller without cancellation,
/// the pairwise force density of Eq. (2) is
///
///   f = c s (xi + eta)/|xi + eta| = (c / |xi|) g(t) (xi + eta),   g(t) = s / (1 + s) = 1 - 1/sqrt(1 + t),
///
/// and a bond breaks, Eq. (5), when s >= s0, that is t >= (1 + s0)^2 - 1: no root is needed to test it.
#pragma once

#include <hwy/highway.h>

#include <cmath>
#include <numbers>
#include <type_traits>

namespace rhexis::peridynamics {

struct Pmb {
  static constexpr bool state_based = false;
  static constexpr double poisson_ratio = 0.25;

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

  /// s0 of a wall that takes G0 to tear: the inverse, sqrt(5 G0 / (6 E delta)).
  static double critical_stretch(double young_modulus, double horizon, double energy_release_rate) {
    return std::sqrt(5 * energy_release_rate / (6 * young_modulus * horizon));
  }

  /// Energy and stiffness of a bond relative to c |xi| s^2 / 2 and to c, which other laws may exceed.
  static double energy_ratio(double) { return 1; }
  static double stiffness_ratio(double) { return 1; }

  /// Eq. (5) in terms of t.
  static double breaking_t(double critical_stretch) { return critical_stretch * (2 + critical_stretch); }
  /// The same, lane by lane.
  template <class D, class V>
  static HWY_INLINE V breaking_t(D d, V critical_stretch) {
    namespace hn = hwy::HWY_NAMESPACE;
    return hn::Mul(critical_stretch, hn::Add(hn::Set(d, hn::TFromD<D>(2)), critical_stretch));
  }

  /// 1 + t. Within a thousandth of a bond's length, where t has lost the digits that this needs, it is held,
  /// so that the force falls to zero with the distance instead of staying c: particles may lie on top of each
  /// other.
  template <class D, class V>
  static HWY_INLINE V squared_length(D d, V t) {
    namespace hn = hwy::HWY_NAMESPACE;
    using Real = hn::TFromD<D>;
    return hn::Max(hn::Add(hn::Set(d, Real{1}), t), hn::Set(d, Real(1e-6)));
  }

  /// g(t), lane by lane, and exactly 0 for t = 0: a wall at rest pulls at nothing. In single precision with
  /// AVX-512, whose approximate root of 1 is 1, the root is approximate and then corrected to third order by
  /// its own residual, in a form that keeps the accuracy of small t: g is within 1e-6 |g| + 5e-11. Others'
  /// approximate roots are coarser, and a root and a division cost them little more.
  template <class D, class V>
  static HWY_INLINE V force_factor(D d, V t) {
    namespace hn = hwy::HWY_NAMESPACE;
    using Real = hn::TFromD<D>;
    const V one = hn::Set(d, Real{1});
    const V a = squared_length(d, t);
    constexpr bool approximate = std::is_same_v<Real, float> && HWY_TARGET <= HWY_AVX3;
    if constexpr (!approximate) {
      return hn::Div(t, hn::Add(a, hn::Sqrt(a)));
    } else {
      const V r = hn::ApproximateReciprocalSqrt(a);
      const V g = hn::Sub(one, r);
      // residual e = 1 - a r^2 = (1 - r^2) - t r^2, fused;  1/sqrt(a) = r (1 + e/2 + 3/8 e^2 + ...)
      const V e = hn::NegMulAdd(t, hn::Mul(r, r), hn::NegMulAdd(r, r, one));
      const V series = hn::MulAdd(e, hn::Set(d, Real(0.375)), hn::Set(d, Real(0.5)));
      return hn::NegMulAdd(hn::Mul(e, r), series, g);
    }
  }

  /// s = g (1 + s), with g = force_factor(t) and 1 + s = (1 + t)(1 - g): no root, and as accurate as g.
  template <class D, class V>
  static HWY_INLINE V stretch(D d, V t, V g) {
    namespace hn = hwy::HWY_NAMESPACE;
    const V one = hn::Set(d, hn::TFromD<D>{1});
    return hn::Mul(hn::Mul(g, squared_length(d, t)), hn::Sub(one, g));
  }

  /// s^2 / 2: the micropotential is w = c |xi| s^2 / 2 (J/m6).
  template <class D, class V>
  static HWY_INLINE V energy_factor(D d, V t) {
    namespace hn = hwy::HWY_NAMESPACE;
    const V s = stretch(d, t, force_factor(d, t));
    return hn::Mul(hn::Mul(s, s), hn::Set(d, hn::TFromD<D>(0.5)));
  }
};

}  // namespace rhexis::peridynamics
