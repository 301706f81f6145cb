// SPDX-License-Identifier: BSD-3-Clause
/// 3 x 3 tensors of numbers (laws/numbers.hpp), and what finite strain needs of a displacement gradient H
/// without the cancellation that 1 + H would bring.
#pragma once

#include <array>

#include "peridynamics/laws/numbers.hpp"

namespace rhexis::peridynamics {

template <Number X>
struct Tensor {
  X xx, xy, xz, yx, yy, yz, zx, zy, zz;

  static HWY_INLINE Tensor zero() { return {X(0), X(0), X(0), X(0), X(0), X(0), X(0), X(0), X(0)}; }
};

template <Number X>
HWY_INLINE Tensor<X> product(X factor, const Tensor<X>& a) {
  return {factor * a.xx, factor * a.xy, factor * a.xz, factor * a.yx, factor * a.yy,
          factor * a.yz, factor * a.zx, factor * a.zy, factor * a.zz};
}

/// Adds factor a.
template <Number X>
HWY_INLINE void add_product(Tensor<X>& sum, X factor, const Tensor<X>& a) {
  sum.xx = multiply_add(factor, a.xx, sum.xx);
  sum.xy = multiply_add(factor, a.xy, sum.xy);
  sum.xz = multiply_add(factor, a.xz, sum.xz);
  sum.yx = multiply_add(factor, a.yx, sum.yx);
  sum.yy = multiply_add(factor, a.yy, sum.yy);
  sum.yz = multiply_add(factor, a.yz, sum.yz);
  sum.zx = multiply_add(factor, a.zx, sum.zx);
  sum.zy = multiply_add(factor, a.zy, sum.zy);
  sum.zz = multiply_add(factor, a.zz, sum.zz);
}

/// Adds scale a (x) b.
template <Number X>
HWY_INLINE void add_dyad(Tensor<X>& sum, X scale, const X (&a)[3], const X (&b)[3]) {
  const X x = scale * a[0], y = scale * a[1], z = scale * a[2];
  sum.xx = multiply_add(x, b[0], sum.xx);
  sum.xy = multiply_add(x, b[1], sum.xy);
  sum.xz = multiply_add(x, b[2], sum.xz);
  sum.yx = multiply_add(y, b[0], sum.yx);
  sum.yy = multiply_add(y, b[1], sum.yy);
  sum.yz = multiply_add(y, b[2], sum.yz);
  sum.zx = multiply_add(z, b[0], sum.zx);
  sum.zy = multiply_add(z, b[1], sum.zy);
  sum.zz = multiply_add(z, b[2], sum.zz);
}

template <Number X>
HWY_INLINE X trace(const Tensor<X>& a) {
  return a.xx + a.yy + a.zz;
}

/// The sum of products of equal components.
template <Number X>
HWY_INLINE X contraction(const Tensor<X>& a, const Tensor<X>& b) {
  return a.xx * b.xx + a.xy * b.xy + a.xz * b.xz + a.yx * b.yx + a.yy * b.yy + a.yz * b.yz + a.zx * b.zx +
         a.zy * b.zy + a.zz * b.zz;
}

/// a b, as an array.
template <Number X>
HWY_INLINE std::array<X, 3> times(const Tensor<X>& a, const X (&b)[3]) {
  return {a.xx * b[0] + a.xy * b[1] + a.xz * b[2], a.yx * b[0] + a.yy * b[1] + a.yz * b[2],
          a.zx * b[0] + a.zy * b[1] + a.zz * b[2]};
}

template <Number X>
HWY_INLINE Tensor<X> cofactor(const Tensor<X>& a) {
  return {a.yy * a.zz - a.yz * a.zy, a.yz * a.zx - a.yx * a.zz, a.yx * a.zy - a.yy * a.zx,
          a.xz * a.zy - a.xy * a.zz, a.xx * a.zz - a.xz * a.zx, a.xy * a.zx - a.xx * a.zy,
          a.xy * a.yz - a.xz * a.yy, a.xz * a.yx - a.xx * a.yz, a.xx * a.yy - a.xy * a.yx};
}

/// The deformation F = 1 + H.
template <Number X>
struct Deformation {
  HWY_INLINE explicit Deformation(const Tensor<X>& h)
      : gradient(h),
        cofactor_of_gradient(cofactor(h)),
        dilation(trace(h) + trace(cofactor_of_gradient) + determinant()) {}

  Tensor<X> gradient;              ///< H
  Tensor<X> cofactor_of_gradient;  ///< cof H
  X dilation;                      ///< J - 1

  /// F
  HWY_INLINE Tensor<X> deformation() const {
    Tensor<X> f = gradient;
    f.xx = f.xx + X(1);
    f.yy = f.yy + X(1);
    f.zz = f.zz + X(1);
    return f;
  }

  HWY_INLINE X volume_ratio() const { return dilation + X(1); }
  /// tr(F^T F) - 3
  HWY_INLINE X first_invariant() const { return X(2) * trace(gradient) + contraction(gradient, gradient); }
  /// cof F = J F^-T, which turns areas: da = cof F dA.
  HWY_INLINE Tensor<X> area_map() const {
    const Tensor<X>&h = gradient, &c = cofactor_of_gradient;
    return {h.yy + h.zz + c.xx + X(1), c.xy - h.yx, c.xz - h.zx, c.yx - h.xy,
            h.xx + h.zz + c.yy + X(1), c.yz - h.zy, c.zx - h.xz, c.zy - h.yz,
            h.xx + h.yy + c.zz + X(1)};
  }

 private:
  HWY_INLINE X determinant() const {
    const Tensor<X>& h = gradient;
    return h.xx * cofactor_of_gradient.xx + h.xy * cofactor_of_gradient.xy + h.xz * cofactor_of_gradient.xz;
  }
};

}  // namespace rhexis::peridynamics
