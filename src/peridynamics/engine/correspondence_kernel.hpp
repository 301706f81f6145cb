// SPDX-License-Identifier: BSD-3-Clause
/// The inner loop of the general engine with a correspondence law: bond forces of 16 particles at once.
///
/// A particle's energy is V W(F) at the deformation gradient F = 1 + H of its family (bonds/gradient.hpp),
/// and what its bonds deviate from F costs
///
///   alpha mu V / (sum_j w V_j) sum_j w V_j |r_ij|^2 / |xi|^2,   r_ij = eta - H xi,
///
/// which vanishes for linear fields and holds all others: gradients alone have modes without energy (Silling
/// 2017, Comput. Meth. Appl. Mech. Eng. 322, 42-57). The derivative by the bond's extension eta is the force
/// state
///
///   T_ij = A_i G_ij + c_i w V_j r_ij / |xi|^2 - f_i w V_j xi . K_i^-1 d_i,
///   A_i = V_i P(F) - c_i sum_j w V_j r_ij (x) xi / |xi|^2,   c_i = 2 alpha mu V_i / (sum_j w V_j),
///
/// where f_i is the pressure's force on the particle's piece of surface, at d_i from it, which moves by u_i +
/// sum_j eta w V_j xi . K_i^-1 d_i; particle i gets sum_j (T_ij - T_ji) + f_i. So a body's law is evaluated
/// once a particle; of the other end only T_ji is needed. Each particle sums its family in its order: on one
/// kind of processor the digits do not depend on threads and ranks. Lengths are in spacings h, stresses in
/// the law's unit mu, forces in mu h^2.
#pragma once

#include <hwy/aligned_allocator.h>

#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/engine/family_blocks.hpp"
#include "peridynamics/laws/correspondence/tensor.hpp"
#include "peridynamics/laws/stretch.hpp"

namespace rhexis::peridynamics {

/// Multiplications and additions for a bond of one of its ends, counted in evaluate_block and sum_forces,
/// without those once a particle.
inline constexpr double flop_per_directed_bond = 141;

/// alpha above.
inline constexpr double penalty_factor = 1;

/// A particle that is squeezed to less of its volume is crushed: it loses all of its bonds, since its law
/// knows no negative volume. Only fragments are.
inline constexpr double least_volume_ratio = 0.1;

/// The surface pieces of the particles of a block, as vectors: components of 16.
template <class Real>
struct BlockLoad {
  alignas(64) Real area[3][16] = {}, offset[3][16] = {};
  alignas(64) Real reach[3][16] = {};  ///< K^-1 d
  alignas(64) Real force[3][16] = {};  ///< f as last evaluated
  alignas(64) Real step[3][16] = {};   ///< displacement of the surface piece as last evaluated, in spacings
};

/// Room for one half of a block's bonds, of all slots.
template <class Real>
struct BondScratch {
  explicit BondScratch(std::size_t slots)
      : values(hwy::AllocateAligned<Real>(10 * 16 * (slots + 1))), broken(slots) {}
  hwy::AlignedFreeUniquePtr<Real[]> values;
  std::vector<std::uint16_t> broken;  ///< [slots] bonds that break now
};

namespace detail {

/// The three numbers of each lane's quad.
template <class D, class Real>
struct Triples {
  hn::Vec<D> part[3];

  HWY_INLINE Triples(D d, const std::vector<Real>& quads, const std::int32_t* offset)
      : Triples(d, quads.data(), offset) {}
  HWY_INLINE Triples(D d, const Real* quads, const std::int32_t* offset) {
    load_triples(d, quads, offset, part);
  }
  HWY_INLINE Lanes<D> operator[](std::size_t k) const { return Lanes<D>(part[k]); }
};

/// Differences of places, as numbers.
template <class D, class Places>
HWY_INLINE Lanes<D> places_apart(D d, const Places& there, const Places& here, std::size_t k) {
  const auto apart = hn::Sub(there.part[k], here.part[k]);
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    return Lanes<D>(hn::ConvertTo(d, apart));
  } else {
    return Lanes<D>(hn::PromoteTo(d, apart));
  }
}

template <class X>
HWY_INLINE X row_dot(X a, X b, X c, const X (&v)[3]) {
  return multiply_add(a, v[0], multiply_add(b, v[1], c * v[2]));
}

}  // namespace detail

/// What is known of the body in one evaluation.
template <class Real>
struct KernelState {
  const Real* u;    ///< quads of known particles, in spacings
  Real breaking_t;  ///< t_of_stretch(critical stretch)
  Real pressure;    ///< in units of mu
  bool follower;
};

/// Evaluates the force states of a block, into `force` ([slots][16][3] of the whole rank), their sums over
/// families, into `sums` ([3][evaluated particles]), and the gradient H of its particles, into `gradients`
/// ([9][evaluated particles]). Breaks bonds that
/// are stretched too far, and those of crushed particles; returns how many. `before` and `after` are called
/// with a block's lanes whose bonds break, before and after what follows from these bonds is changed. `law`
/// is that at the rank's particles (AtParticles of the laws).
template <class Law, class Real, class Before, class After>
int evaluate_block(const Law& law, FamilyBlocks<Real>& family, const KernelState<Real>& state,
                   std::size_t block, BlockLoad<Real>* load, BondScratch<Real>& scratch, Real* force,
                   std::array<std::vector<Real>, 3>& sums, std::array<std::vector<Real>, 9>& gradients,
                   const Before& before, const After& after) {
  using D = hn::CappedTag<Real, block_rows>;
  using X = Lanes<D>;
  using DI = hn::Rebind<std::int32_t, D>;
  const D d;
  const DI di;
  constexpr std::size_t width = static_cast<std::size_t>(block_rows);
  const std::size_t n = hn::Lanes(d), first = family.first_slot(block), slots = family.slots(block);
  int broken_bonds = 0;
  for (std::size_t lane = 0; lane < width; lane += n) {
    const std::size_t here = block * width + lane;
    Real* const room = scratch.values.get();
    const auto at = [&](std::size_t value, std::size_t slot) { return room + (10 * slot + value) * n; };
    std::int32_t here_quad[width];
    for (std::size_t k = 0; k < n; ++k) here_quad[k] = static_cast<std::int32_t>(quad * (here + k));
    const detail::Triples<DI, std::int32_t> own_place(di, family.place, here_quad);
    const detail::Triples<D, Real> own(d, state.u, here_quad), own_m(d, family.multiplier, here_quad);
    const X volume = X::load(family.volume.data() + here);
    Tensor<X> h = Tensor<X>::zero(), pulled = h;
    X surface[3] = {own[0], own[1], own[2]}, push[3] = {X(0), X(0), X(0)}, reach[3] = {X(0), X(0), X(0)};
    for (unsigned crushed = 0;;) {
      unsigned breaking = 0;
      for (std::size_t slot = 0; slot < slots; ++slot) {
        const std::int32_t* const index = family.partner.data() + (first + slot) * width + lane;
        const detail::Triples<DI, std::int32_t> place(di, family.place, index);
        const detail::Triples<D, Real> u(d, state.u, index), m(d, family.multiplier, index);
        X xi[3] = {X(0), X(0), X(0)}, eta[3] = {X(0), X(0), X(0)};
        for (std::size_t k = 0; k < 3; ++k) {
          xi[k] = detail::places_apart(d, place, own_place, k) * X(place_step);
          eta[k] = u[k] - own[k];
          xi[k].store(at(k, slot));
          eta[k].store(at(3 + k, slot));
          (m[k] - own_m[k]).store(at(6 + k, slot));
        }
        const X length2 = multiply_add(xi[0], xi[0], multiply_add(xi[1], xi[1], xi[2] * xi[2]));
        const X inverse2 = X(1) / max(length2, X(Real(1e-6)));
        const X t = inverse2 * multiply_add(eta[0], X(2) * xi[0] + eta[0],
                                            multiply_add(eta[1], X(2) * xi[1] + eta[1],
                                                         eta[2] * (X(2) * xi[2] + eta[2])));
        inverse2.store(at(9, slot));
        const auto fails = detail::bits_of(d, t >= X(state.breaking_t), lane);
        scratch.broken[slot] = static_cast<std::uint16_t>(family.words[first + slot] & (fails | crushed));
        breaking |= scratch.broken[slot];
      }
      if (HWY_UNLIKELY(breaking != 0)) {
        before(block, breaking);
        for (std::size_t slot = 0; slot < slots; ++slot) {
          broken_bonds += std::popcount(scratch.broken[slot]);
          family.words[first + slot] =
              static_cast<std::uint16_t>(family.words[first + slot] & ~scratch.broken[slot]);
        }
        family.update(block, breaking);
        after(block, breaking);
      }

      const auto b = [&](std::size_t k) { return X::load(family.slope[k].data() + here); };
      const X b_[9] = {b(0), b(1), b(2), b(3), b(4), b(5), b(6), b(7), b(8)};
      h = pulled = Tensor<X>::zero();
      for (std::size_t k = 0; k < 3; ++k) surface[k] = own[k];
      if (load != nullptr) {
        for (std::size_t k = 0; k < 3; ++k) reach[k] = X::load(load->reach[k] + lane);
      }
      for (std::size_t slot = 0; slot < slots; ++slot) {
        const X w = where(detail::lanes_of(d, family.words[first + slot], lane),
                          X::load(family.weight.data() + (first + slot) * width + lane));
        const X xi[3] = {X::load(at(0, slot)), X::load(at(1, slot)), X::load(at(2, slot))};
        const X eta[3] = {X::load(at(3, slot)), X::load(at(4, slot)), X::load(at(5, slot))};
        const X g[3] = {
            w * multiply_add(volume, X::load(at(6, slot)), detail::row_dot(b_[0], b_[1], b_[2], xi)),
            w * multiply_add(volume, X::load(at(7, slot)), detail::row_dot(b_[3], b_[4], b_[5], xi)),
            w * multiply_add(volume, X::load(at(8, slot)), detail::row_dot(b_[6], b_[7], b_[8], xi))};
        add_dyad(h, X(1), eta, g);
        const X stiffness = w * X::load(at(9, slot));
        add_dyad(pulled, stiffness, eta, xi);
        if (load != nullptr) {
          const X share = w * detail::row_dot(reach[0], reach[1], reach[2], xi);
          for (std::size_t k = 0; k < 3; ++k) surface[k] = multiply_add(share, eta[k], surface[k]);
        }
        for (std::size_t k = 0; k < 3; ++k) g[k].store(at(6 + k, slot));
        stiffness.store(at(9, slot));
      }
      crushed = detail::bits_of(d, Deformation<X>(h).dilation < X(Real(least_volume_ratio - 1)), lane);
      if (HWY_LIKELY(crushed == 0)) break;
    }
    const X strength = X::load(family.strength.data() + here);
    const X stressed = strength * volume;
    const X penalty = X(Real(2 * penalty_factor)) * law.template shear_modulus<X>(here) * stressed *
                      X::load(family.inverse_weight.data() + here);
    const Deformation<X> f(h);
    Tensor<X> a = law.stress(f, here);
    const auto s = [&](std::size_t k) { return X::load(family.shape[k].data() + here); };
    const X m[6] = {s(0), s(1), s(2), s(3), s(4), s(5)};
    // c_i sum_j w V_j r (x) xi / |xi|^2, with r = eta - H xi.
    const auto row = [&](X& x, X& y, X& z, X hx, X hy, X hz, X px, X py, X pz) {
      const X rx = px - (hx * m[0] + hy * m[3] + hz * m[4]);
      const X ry = py - (hx * m[3] + hy * m[1] + hz * m[5]);
      const X rz = pz - (hx * m[4] + hy * m[5] + hz * m[2]);
      x = stressed * x - penalty * rx;
      y = stressed * y - penalty * ry;
      z = stressed * z - penalty * rz;
    };
    row(a.xx, a.xy, a.xz, h.xx, h.xy, h.xz, pulled.xx, pulled.xy, pulled.xz);
    row(a.yx, a.yy, a.yz, h.yx, h.yy, h.yz, pulled.yx, pulled.yy, pulled.yz);
    row(a.zx, a.zy, a.zz, h.zx, h.zy, h.zz, pulled.zx, pulled.zy, pulled.zz);
    if (load != nullptr) {
      const X area[3] = {X::load(load->area[0] + lane), X::load(load->area[1] + lane),
                         X::load(load->area[2] + lane)};
      const X pressure = X(-state.pressure) * strength;
      const Tensor<X> map = f.area_map();
      push[0] = pressure * (state.follower ? detail::row_dot(map.xx, map.xy, map.xz, area) : area[0]);
      push[1] = pressure * (state.follower ? detail::row_dot(map.yx, map.yy, map.yz, area) : area[1]);
      push[2] = pressure * (state.follower ? detail::row_dot(map.zx, map.zy, map.zz, area) : area[2]);
      for (std::size_t k = 0; k < 3; ++k) {
        push[k].store(load->force[k] + lane);
        surface[k].store(load->step[k] + lane);
      }
    }
    const X* const components[9] = {&h.xx, &h.xy, &h.xz, &h.yx, &h.yy, &h.yz, &h.zx, &h.zy, &h.zz};
    for (std::size_t k = 0; k < 9; ++k) components[k]->store(gradients[k].data() + here);

    X sum[3] = {X(0), X(0), X(0)};
    for (std::size_t slot = 0; slot < slots; ++slot) {
      const X xi[3] = {X::load(at(0, slot)), X::load(at(1, slot)), X::load(at(2, slot))};
      const X g[3] = {X::load(at(6, slot)), X::load(at(7, slot)), X::load(at(8, slot))};
      const X stiffness = penalty * X::load(at(9, slot));
      const X r[3] = {X::load(at(3, slot)) - detail::row_dot(h.xx, h.xy, h.xz, xi),
                      X::load(at(4, slot)) - detail::row_dot(h.yx, h.yy, h.yz, xi),
                      X::load(at(5, slot)) - detail::row_dot(h.zx, h.zy, h.zz, xi)};
      X t[3] = {multiply_add(stiffness, r[0], detail::row_dot(a.xx, a.xy, a.xz, g)),
                multiply_add(stiffness, r[1], detail::row_dot(a.yx, a.yy, a.yz, g)),
                multiply_add(stiffness, r[2], detail::row_dot(a.zx, a.zy, a.zz, g))};
      if (load != nullptr) {
        const X w = where(detail::lanes_of(d, family.words[first + slot], lane),
                          X::load(family.weight.data() + (first + slot) * width + lane));
        const X share = w * detail::row_dot(reach[0], reach[1], reach[2], xi);
        for (std::size_t k = 0; k < 3; ++k) t[k] = negative_multiply_add(share, push[k], t[k]);
      }
      // What a slot's last vector would overwrite is the next slot's, which is written before it.
      store_triples(d, t, force + 3 * (width * (first + slot) + lane), lane + n == width);
      for (std::size_t k = 0; k < 3; ++k) sum[k] = sum[k] + t[k];
    }
    for (std::size_t k = 0; k < 3; ++k) sum[k].store(sums[k].data() + here);
  }
  return broken_bonds;
}

/// Sums T_ij - T_ji over the families of a block's particles, into `sum`; `own` are the sums of T_ij.
template <class Real>
void sum_forces(const FamilyBlocks<Real>& family, std::size_t block, const Real* force,
                const std::array<std::vector<Real>, 3>& own, Real (&sum)[3][16]) {
  using D = hn::CappedTag<Real, block_rows>;
  using X = Lanes<D>;
  const D d;
  constexpr std::size_t width = static_cast<std::size_t>(block_rows);
  const std::size_t n = hn::Lanes(d), first = family.first_slot(block), slots = family.slots(block);
  for (std::size_t lane = 0; lane < width; lane += n) {
    X total[3] = {X(0), X(0), X(0)};
    for (std::size_t slot = first; slot < first + slots; ++slot) {
      const detail::Triples<D, Real> t(d, force, family.reverse.data() + slot * width + lane);
      for (std::size_t k = 0; k < 3; ++k) total[k] = total[k] + t[k];
    }
    for (std::size_t k = 0; k < 3; ++k)
      (X::load(own[k].data() + block * width + lane) - total[k]).store(&sum[k][lane]);
  }
}

}  // namespace rhexis::peridynamics
