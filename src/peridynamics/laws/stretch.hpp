// SPDX-License-Identifier: BSD-3-Clause
/// Stretch of a bond, in terms of t = (|xi + eta|^2 - |xi|^2) / |xi|^2 = (1 + s)^2 - 1, which the caller
/// computes without cancellation. Every law is written in t, so that no root is needed to test for breaking.
#pragma once

#include "peridynamics/laws/numbers.hpp"

namespace rhexis::peridynamics {

/// t of a stretch s. Eq. (5): a bond of critical stretch s0 breaks when t >= t_of_stretch(s0).
template <Number X>
HWY_INLINE X t_of_stretch(X s) {
  return s * (2 + s);
}

/// (1 + s)^2 = 1 + t. Within a thousandth of a bond's length, where t has lost the digits that this needs, it
/// is held, so that the force falls to zero with the distance instead of staying c: particles may lie on top
/// of each other.
template <Number X>
HWY_INLINE X squared_length(X t) {
  return max(1 + t, X(1e-6));
}

/// g(t) = s / (1 + s) = 1 - 1/sqrt(1 + t), exactly 0 for t = 0: a wall at rest pulls at nothing. In single
/// precision with AVX-512, whose approximate root of 1 is 1, the root is approximate and then corrected to
/// third order by its own residual, in a form that keeps the accuracy of small t: g is within 1e-6 |g| +
/// 5e-11. Others' approximate roots are coarser, and a root and a division cost them little more.
template <Number X>
HWY_INLINE X stretch_over_length(X t) {
  const X a = squared_length(t);
  if constexpr (!has_approximate_inverse_sqrt<X>) {
    return t / (a + sqrt(a));
  } else {
    const X r = approximate_inverse_sqrt(a);
    // residual e = 1 - a r^2 = (1 - r^2) - t r^2, fused;  1/sqrt(a) = r (1 + e/2 + 3/8 e^2 + ...)
    const X e = negative_multiply_add(t, r * r, negative_multiply_add(r, r, X(1)));
    return negative_multiply_add(e * r, multiply_add(e, X(0.375), X(0.5)), 1 - r);
  }
}

/// s from t and g = stretch_over_length(t), as g (1 + s) with 1 + s = (1 + t)(1 - g): no root, and as
/// accurate as g.
template <Number X>
HWY_INLINE X stretch(X t, X g) {
  return g * squared_length(t) * (1 - g);
}

/// s from t.
template <Number X>
HWY_INLINE X stretch(X t) {
  return stretch(t, stretch_over_length(t));
}

}  // namespace rhexis::peridynamics
