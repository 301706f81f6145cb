// SPDX-License-Identifier: BSD-3-Clause
/// The numbers that bond laws are written in, once: float, double, and vectors of them (Lanes).
#pragma once

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <type_traits>

namespace rhexis::peridynamics {

namespace hn = hwy::HWY_NAMESPACE;

/// A vector of numbers, with the operators of one. `D` is a descriptor of Google Highway; Real is float or
/// double. Numbers turn into vectors of equal lanes by themselves.
template <class D>
class Lanes {
 public:
  using Real = hn::TFromD<D>;
  using Vector = hn::Vec<D>;

  HWY_INLINE Lanes(Real number) : vector(hn::Set(D(), number)) {}
  HWY_INLINE explicit Lanes(Vector v) : vector(v) {}
  static HWY_INLINE Lanes load(const Real* from) { return Lanes(hn::LoadU(D(), from)); }
  HWY_INLINE void store(Real* to) const { hn::StoreU(vector, D(), to); }

  friend HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return Lanes(hn::Add(a.vector, b.vector)); }
  friend HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return Lanes(hn::Sub(a.vector, b.vector)); }
  friend HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return Lanes(hn::Mul(a.vector, b.vector)); }
  friend HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return Lanes(hn::Div(a.vector, b.vector)); }
  friend HWY_INLINE Lanes max(Lanes a, Lanes b) { return Lanes(hn::Max(a.vector, b.vector)); }
  friend HWY_INLINE Lanes round(Lanes a) { return Lanes(hn::Round(a.vector)); }
  friend HWY_INLINE Lanes sqrt(Lanes a) { return Lanes(hn::Sqrt(a.vector)); }
  friend HWY_INLINE Lanes exp(Lanes a) { return Lanes(hn::Exp(D(), a.vector)); }
  friend HWY_INLINE Lanes expm1(Lanes a) { return Lanes(hn::Expm1(D(), a.vector)); }
  /// a b + c, rounded once where the processor can.
  friend HWY_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
    return Lanes(hn::MulAdd(a.vector, b.vector, c.vector));
  }
  /// c - a b, rounded once where the processor can.
  friend HWY_INLINE Lanes negative_multiply_add(Lanes a, Lanes b, Lanes c) {
    return Lanes(hn::NegMulAdd(a.vector, b.vector, c.vector));
  }

  /// Lanes in which the comparison holds.
  using Mask = hn::Mask<D>;
  friend HWY_INLINE Mask operator>=(Lanes a, Lanes b) { return hn::Ge(a.vector, b.vector); }
  friend HWY_INLINE Mask operator<(Lanes a, Lanes b) { return hn::Lt(a.vector, b.vector); }
  /// `a` in the lanes of `mask`, 0 in others.
  friend HWY_INLINE Lanes where(Mask mask, Lanes a) { return Lanes(hn::IfThenElseZero(mask, a.vector)); }

  Vector vector;
};

template <class X>
inline constexpr bool is_lanes = false;
template <class D>
inline constexpr bool is_lanes<Lanes<D>> = true;

template <class X>
concept Number = std::floating_point<X> || is_lanes<X>;

// Found for numbers; for Lanes the functions above are.
using std::exp;
using std::expm1;
using std::max;
using std::sqrt;

template <std::floating_point X>
HWY_INLINE X multiply_add(X a, X b, X c) {
  return a * b + c;
}

/// Whether 1/sqrt has an approximation in X that is quicker than a root and a division, and 1 for 1.
template <Number X>
inline constexpr bool has_approximate_inverse_sqrt = false;
template <class D>
inline constexpr bool has_approximate_inverse_sqrt<Lanes<D>> =
    std::is_same_v<typename Lanes<D>::Real, float>&& HWY_TARGET <= HWY_AVX3;

/// 1/sqrt(a) to about 14 bits.
template <class D>
HWY_INLINE Lanes<D> approximate_inverse_sqrt(Lanes<D> a) {
  return Lanes<D>(hn::ApproximateReciprocalSqrt(a.vector));
}

}  // namespace rhexis::peridynamics
