// SPDX-License-Identifier: BSD-3-Clause
/// The inner loop: forces of one column's bonds on 16 of its rows at once (Eqs. 1, 2, 5).
///
/// Every particle sums its family in the family's fixed order, lane by lane, so that on one kind of processor
/// the digits do not depend on threads and ranks. |xi + eta|^2 is computed from terms that change only their
/// sign between the two ends of a bond: both ends break it in the same step, and its force is the same
/// whether each end evaluates it for itself or one for both.
///
/// Lengths are in spacings. With y = xi + eta:  t = eta . (2 xi + eta) / |xi|^2  is (1 + s)^2 - 1 without
/// cancellation.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

#include "parallel/partition.hpp"
#include "peridynamics/engine/following_frame.hpp"
#include "peridynamics/laws/stretch.hpp"

namespace rhexis::peridynamics {

/// Properties of particles by place, where the wall is not uniform; padded as displacement is. A bond's
/// property is the sum of its ends' halves: the same digits from both ends, so that both break the bond in
/// the same step.
template <class Real>
struct LocalProperties {
  const Real* half_stretch = nullptr;    ///< half of the critical stretch
  const Real* half_stiffness = nullptr;  ///< half of the factor on the bond constant
};

/// A bond as the kernel wants it; 44 bytes in single precision.
template <class Real>
struct BondConstants {
  Real xi[3] = {};
  Real inverse_length2;   ///< 1 / |xi|^2
  Real twice_xi[3] = {};  ///< 2 xi / |xi|^2
  Real weight;  ///< w V_i V_j / (spacing^6 |xi|): force is c spacing^6 sum weight g(t) y, of either end
  Real volume;  ///< V_j / spacing^3
  Real energy_weight;   ///< w V_i V_j |xi| / spacing^6: energy is c spacing^7 energy_weight s^2/2
  std::int32_t offset;  ///< where the partner stands in padded arrays, from the particle's own place
};

/// Bonds [first, past) of a family that are evaluated for this end only, or for both.
struct BondRun {
  std::int32_t first, past;
  bool both;
  int ends;  ///< ends of a bond that count here: 2 for forward bonds, whoever evaluates them, else 0
};

/// A bond of a family that broke in some rows.
struct BrokenBond {
  std::int32_t bond;
  std::uint16_t rows;
};

/// One block of 16 rows of one column: what its bonds read, the bits they may clear, and the sums they add
/// to.
template <class Real>
struct BlockView {
  const Real* u[3];  ///< padded displacement, at the block's first row
  std::span<const BondConstants<Real>> bonds;
  std::uint16_t* intact;             ///< one word per bond, bit k: bond of row k exists and is unbroken
  std::array<Real*, 4> sums = {};    ///< force x, y, z and, when observing, energy, at the block's first row
  Real breaking_t;                   ///< t at which bonds of a uniform wall break
  LocalProperties<Real> local = {};  ///< properties of a wall that is not uniform, at the block's first row
  const Real* pressure = nullptr;    ///< pressure of a state-based law, at the block's first row
  BrokenBond* broken = nullptr;      ///< room for bonds that break and are evaluated for both ends
};

/// What happened in a block.
struct BlockEvents {
  int broken = 0;                   ///< directed bonds of these rows that broke now
  std::size_t broken_for_both = 0;  ///< how many are in BlockView::broken
  int crushed = 0;  ///< ends of bonds shorter than half their length, as BondRun::ends; when observing
};

/// Floating-point operations of one bond that pulls, for both of its ends: 6 for eta and y, 11 for t, 13 for
/// g(t), 1 for k, 12 for the forces (a fused multiply-add counts as two, the approximate root as one). A bond
/// that is evaluated twice, because no thread has both of its ends, counts once.
inline constexpr double flop_per_bond = 43;

namespace detail {

/// The mask whose bits are `word` >> first_lane.
template <class D>
HWY_INLINE hn::Mask<D> lanes_of(D d, const std::uint16_t& word, std::size_t first_lane) {
  if constexpr (hn::MaxLanes(D()) >= 8) {
    return hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&word) + first_lane / 8);
  } else {
    const auto bits = static_cast<std::uint8_t>(word >> first_lane);
    const std::uint8_t padded[8] = {bits};
    return hn::LoadMaskBits(d, padded);
  }
}

template <class D>
HWY_INLINE std::uint16_t bits_of(D d, hn::Mask<D> mask, std::size_t first_lane) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  std::uint16_t word;
  std::memcpy(&word, bytes, sizeof word);
  return static_cast<std::uint16_t>(word << first_lane);
}

/// A bond as it is now: y = xi + eta, t as in the opening comment.
template <class D>
struct Deformed {
  Lanes<D> y_x, y_y, y_z, t;
};

/// The rows from `lane` on of a block, one end of all their bonds. `wrapped`: displacements are known up to
/// whole periods, so that they keep their digits however far fragments have flown.
template <bool wrapped, class D, class Real>
class Ends {
  using X = Lanes<D>;

 public:
  HWY_INLINE Ends(const BlockView<Real>& block, std::size_t lane)
      : u_{block.u[0] + lane, block.u[1] + lane, block.u[2] + lane},
        u_x_(X::load(u_[0])),
        u_y_(X::load(u_[1])),
        u_z_(X::load(u_[2])) {}

  HWY_INLINE Deformed<D> deformed(const BondConstants<Real>& bond) const {
    const X eta_x = apart(X::load(u_[0] + bond.offset), u_x_);
    const X eta_y = apart(X::load(u_[1] + bond.offset), u_y_);
    const X eta_z = apart(X::load(u_[2] + bond.offset), u_z_);
    const X inverse = bond.inverse_length2;
    const X t_x = eta_x * multiply_add(eta_x, inverse, X(bond.twice_xi[0]));
    const X t_xy = multiply_add(eta_y, multiply_add(eta_y, inverse, X(bond.twice_xi[1])), t_x);
    const X t = multiply_add(eta_z, multiply_add(eta_z, inverse, X(bond.twice_xi[2])), t_xy);
    return {eta_x + bond.xi[0], eta_y + bond.xi[1], eta_z + bond.xi[2], t};
  }

 private:
  static HWY_INLINE X apart(X there, X here) {
    const X eta = there - here;
    if constexpr (!wrapped) return eta;
    return negative_multiply_add(round(eta * Real(1 / wrap_period)), X(Real(wrap_period)), eta);
  }

  const Real* u_[3];
  X u_x_, u_y_, u_z_;
};

/// Eq. (5) for bonds of the rows from `lane` on of a block, uniform or by place.
template <bool heterogeneous, class D, class Real>
class BreakingTest {
  using X = Lanes<D>;

 public:
  HWY_INLINE BreakingTest(const BlockView<Real>& block, std::size_t lane)
      : uniform_t_(block.breaking_t), half_stretch_(Real{0}) {
    if constexpr (heterogeneous) {
      there_ = block.local.half_stretch + lane;
      half_stretch_ = X::load(there_);
    }
  }

  HWY_INLINE hn::Mask<D> fails(const BondConstants<Real>& bond, X t) const {
    if constexpr (!heterogeneous) return t >= uniform_t_;
    return t >= t_of_stretch(half_stretch_ + X::load(there_ + bond.offset));
  }

 private:
  X uniform_t_, half_stretch_;
  const Real* there_ = nullptr;
};

/// Clears the bits of a word's bonds that `fail`; returns which they were. Compared as bits, for compilers
/// then make one masked comparison of it.
template <class D>
HWY_INLINE std::uint16_t clear(D d, hn::Mask<D> fail, std::size_t lane, std::uint16_t& word) {
  const auto broken = static_cast<std::uint16_t>(word & bits_of(d, fail, lane));
  if (HWY_UNLIKELY(broken != 0)) word = static_cast<std::uint16_t>(word & ~broken);
  return broken;
}

/// Sums of the rows from `lane` on of a block so far.
template <class D>
struct Sums {
  Lanes<D> x, y, z, energy;
};

/// Adds `change` to the numbers at `place`.
template <class D, class Real>
HWY_INLINE void add_at(Real* place, Lanes<D> change) {
  (change + Lanes<D>::load(place)).store(place);
}

/// Subtracts k y from the numbers at `place`.
template <class D, class Real>
HWY_INLINE void subtract_product_at(Real* place, Lanes<D> k, Lanes<D> y) {
  negative_multiply_add(k, y, Lanes<D>::load(place)).store(place);
}

/// Adds the bonds of a run, those `both` to the sums of their other ends too.
template <bool both, bool observing, bool heterogeneous, bool wrapped, class D, class Law, class Real>
HWY_INLINE void add_run(D d, const Law law, const BlockView<Real>& block, std::size_t lane, const BondRun run,
                        Sums<D>& sum, BlockEvents& events) {
  using X = Lanes<D>;
  const Ends<wrapped, D, Real> ends(block, lane);
  const BreakingTest<heterogeneous, D, Real> test(block, lane);
  X half_stiffness = Real{0}, pressure = Real{0};
  if constexpr (heterogeneous) half_stiffness = X::load(block.local.half_stiffness + lane);
  if constexpr (Law::state_based) pressure = X::load(block.pressure + lane);
  Sums<D> f = sum;
  std::array<Real*, 4> others = {};
  for (std::size_t k = 0; both && k < (observing ? 4 : 3); ++k) others[k] = block.sums[k] + lane;
  const std::uint16_t* const past = block.intact + run.past;
  std::uint16_t* next_word = block.intact + run.first;
  const BondConstants<Real>* next_bond = block.bonds.data() + run.first;
  const auto skip_broken = [&] {
    while (next_word != past && *next_word == 0) ++next_word, ++next_bond;
  };
  skip_broken();
  if (next_word == past) return;
  // Two bonds at a time, the next one's stretch beside this one's force: what a processor can hold of
  // instructions that wait for others is soon full, and one bond is a long chain of them.
  Deformed<D> next = ends.deformed(*next_bond);
  do {
    const BondConstants<Real>& bond = *next_bond++;
    std::uint16_t& word = *next_word++;
    const auto [y_x, y_y, y_z, t] = next;
    skip_broken();
    if (next_word != past) next = ends.deformed(*next_bond);
    const std::uint16_t broken = clear(d, test.fails(bond, t), lane, word);
    if (HWY_UNLIKELY(broken != 0)) {
      events.broken += std::popcount(broken);
      if constexpr (both) {
        const auto number = static_cast<std::int32_t>(&word - block.intact);
        block.broken[events.broken_for_both++] = {number, broken};
      }
    }
    const auto pulling = lanes_of(d, word, lane);
    [[maybe_unused]] const std::ptrdiff_t there = bond.offset;
    const X g = law.force_factor(t);
    X stiffness = Real{1}, pull = g;
    if constexpr (heterogeneous) {
      stiffness = half_stiffness + X::load(block.local.half_stiffness + lane + there);
      pull = g * stiffness;
    }
    if constexpr (Law::state_based) {
      const X pressures = pressure + X::load(block.pressure + lane + there);
      pull = multiply_add(pressures, 1 - g, pull);  // 1 - g = 1 / (1 + s)
    }
    const X k = where(pulling, pull * bond.weight);
    f.x = multiply_add(k, y_x, f.x);
    f.y = multiply_add(k, y_y, f.y);
    f.z = multiply_add(k, y_z, f.z);
    if constexpr (both) {
      subtract_product_at(others[0] + there, k, y_x);
      subtract_product_at(others[1] + there, k, y_y);
      subtract_product_at(others[2] + there, k, y_z);
    }
    if constexpr (observing) {
      X w = law.energy_factor(t) * bond.energy_weight;
      if constexpr (heterogeneous) w = w * stiffness;
      w = where(pulling, w);
      f.energy = f.energy + w;
      if constexpr (both) add_at(others[3] + there, w);
      const auto crushed = hn::And(pulling, t < Real(-0.75));
      events.crushed += static_cast<int>(hn::CountTrue(d, crushed)) * run.ends;
    }
  } while (next_word != past);
  sum = f;
}

}  // namespace detail

/// Breaks what is stretched too far, then adds the forces of what is left of `runs`, with `observing` also
/// their strain energy to either end. Only a `heterogeneous` wall pays for properties by place, only a
/// `wrapped` one for displacements that are known up to whole periods, and only a state-based law for the
/// pressures p of its particles, which add p_i + p_j to the stretch (laws/lps.hpp).
template <bool observing, bool heterogeneous, bool wrapped, class Law, class Real>
HWY_INLINE void sum_block(const Law law, const BlockView<Real>& block, std::span<const BondRun> runs,
                          BlockEvents& events) {
  using D = hn::CappedTag<Real, parallel::block_rows>;
  const D d;
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(parallel::block_rows); lane += hn::Lanes(d)) {
    // Apart from the sums in memory: bonds of these rows with each other add to those meanwhile.
    detail::Sums<D> sum{Real{0}, Real{0}, Real{0}, Real{0}};
    for (const BondRun run : runs) {
      if (run.both) {
        detail::add_run<true, observing, heterogeneous, wrapped>(d, law, block, lane, run, sum, events);
      } else {
        detail::add_run<false, observing, heterogeneous, wrapped>(d, law, block, lane, run, sum, events);
      }
    }
    detail::add_at(block.sums[0] + lane, sum.x);
    detail::add_at(block.sums[1] + lane, sum.y);
    detail::add_at(block.sums[2] + lane, sum.z);
    if constexpr (observing) detail::add_at(block.sums[3] + lane, sum.energy);
  }
}

}  // namespace rhexis::peridynamics
