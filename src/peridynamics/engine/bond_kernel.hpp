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

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

#include "parallel/partition.hpp"
#include "peridynamics/engine/following_frame.hpp"

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
  std::int32_t offset;  ///< of the partner in padded arrays, from the particle's own place
};

/// Bonds [first, past) of a family that are evaluated for this end only, or for both.
struct BondRun {
  std::int32_t first, past;
  bool both;
  int ends;  ///< of each bond that count here: 2 for forward bonds, whoever evaluates them, else 0
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

namespace hn = hwy::HWY_NAMESPACE;

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
template <class V>
struct Deformed {
  V y_x, y_y, y_z, t;
};

/// The rows from `lane` on of a block, one end of all their bonds. `wrapped`: displacements are known up to
/// whole periods, so that they keep their digits however far fragments have flown.
template <bool wrapped, class D, class Real>
class Ends {
 public:
  HWY_INLINE Ends(D d, const BlockView<Real>& block, std::size_t lane)
      : u_{block.u[0] + lane, block.u[1] + lane, block.u[2] + lane},
        u_x_(hn::LoadU(d, u_[0])),
        u_y_(hn::LoadU(d, u_[1])),
        u_z_(hn::LoadU(d, u_[2])) {}

  HWY_INLINE Deformed<hn::Vec<D>> deformed(D d, const BondConstants<Real>& bond) const {
    using V = hn::Vec<D>;
    const V eta_x = apart(d, hn::LoadU(d, u_[0] + bond.offset), u_x_);
    const V eta_y = apart(d, hn::LoadU(d, u_[1] + bond.offset), u_y_);
    const V eta_z = apart(d, hn::LoadU(d, u_[2] + bond.offset), u_z_);
    const V inverse = hn::Set(d, bond.inverse_length2);
    const V t_x = hn::Mul(eta_x, hn::MulAdd(eta_x, inverse, hn::Set(d, bond.twice_xi[0])));
    const V t_xy = hn::MulAdd(eta_y, hn::MulAdd(eta_y, inverse, hn::Set(d, bond.twice_xi[1])), t_x);
    const V t = hn::MulAdd(eta_z, hn::MulAdd(eta_z, inverse, hn::Set(d, bond.twice_xi[2])), t_xy);
    return {hn::Add(eta_x, hn::Set(d, bond.xi[0])), hn::Add(eta_y, hn::Set(d, bond.xi[1])),
            hn::Add(eta_z, hn::Set(d, bond.xi[2])), t};
  }

 private:
  static HWY_INLINE hn::Vec<D> apart(D d, hn::Vec<D> there, hn::Vec<D> here) {
    const hn::Vec<D> eta = hn::Sub(there, here);
    if constexpr (!wrapped) return eta;
    const hn::Vec<D> periods = hn::Round(hn::Mul(eta, hn::Set(d, Real(1 / wrap_period))));
    return hn::NegMulAdd(periods, hn::Set(d, Real(wrap_period)), eta);
  }

  const Real* u_[3];
  hn::Vec<D> u_x_, u_y_, u_z_;
};

/// Eq. (5) for bonds of the rows from `lane` on of a block, uniform or by place.
template <bool heterogeneous, class D, class Real>
class BreakingTest {
 public:
  HWY_INLINE BreakingTest(D d, const BlockView<Real>& block, std::size_t lane)
      : uniform_t_(hn::Set(d, block.breaking_t)), half_stretch_(hn::Zero(d)) {
    if constexpr (heterogeneous) {
      there_ = block.local.half_stretch + lane;
      half_stretch_ = hn::LoadU(d, there_);
    }
  }

  template <class Law>
  HWY_INLINE hn::Mask<D> fails(D d, const Law law, const BondConstants<Real>& bond, hn::Vec<D> t) const {
    if constexpr (heterogeneous) {
      const auto stretch = hn::Add(half_stretch_, hn::LoadU(d, there_ + bond.offset));
      return hn::Ge(t, law.breaking_t(d, stretch));
    } else {
      return hn::Ge(t, uniform_t_);
    }
  }

 private:
  hn::Vec<D> uniform_t_, half_stretch_;
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
  hn::Vec<D> x, y, z, energy;
};

/// Adds the bonds of a run, those `both` to the sums of their other ends too.
template <bool both, bool observing, bool heterogeneous, bool wrapped, class D, class Law, class Real>
HWY_INLINE void add_run(D d, const Law law, const BlockView<Real>& block, std::size_t lane, const BondRun run,
                        Sums<D>& sum, BlockEvents& events) {
  using V = hn::Vec<D>;
  const Ends<wrapped, D, Real> ends(d, block, lane);
  const BreakingTest<heterogeneous, D, Real> test(d, block, lane);
  V half_stiffness = hn::Zero(d), pressure = hn::Zero(d);
  if constexpr (heterogeneous) half_stiffness = hn::LoadU(d, block.local.half_stiffness + lane);
  if constexpr (Law::state_based) pressure = hn::LoadU(d, block.pressure + lane);
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
  Deformed<V> next = ends.deformed(d, *next_bond);
  do {
    const BondConstants<Real>& bond = *next_bond++;
    std::uint16_t& word = *next_word++;
    const auto [y_x, y_y, y_z, t] = next;
    skip_broken();
    if (next_word != past) next = ends.deformed(d, *next_bond);
    const std::uint16_t broken = clear(d, test.fails(d, law, bond, t), lane, word);
    if (HWY_UNLIKELY(broken != 0)) {
      events.broken += std::popcount(broken);
      if constexpr (both) {
        const auto number = static_cast<std::int32_t>(&word - block.intact);
        block.broken[events.broken_for_both++] = {number, broken};
      }
    }
    const auto pulling = lanes_of(d, word, lane);
    [[maybe_unused]] const std::ptrdiff_t there = bond.offset;
    const V one = hn::Set(d, Real{1});
    const V g = law.force_factor(d, t);
    V stiffness = one, pull = g;
    if constexpr (heterogeneous) {
      stiffness = hn::Add(half_stiffness, hn::LoadU(d, block.local.half_stiffness + lane + there));
      pull = hn::Mul(g, stiffness);
    }
    if constexpr (Law::state_based) {
      const V pressures = hn::Add(pressure, hn::LoadU(d, block.pressure + lane + there));
      pull = hn::MulAdd(pressures, hn::Sub(one, g), pull);  // 1 - g = 1 / (1 + s)
    }
    const V k = hn::IfThenElseZero(pulling, hn::Mul(pull, hn::Set(d, bond.weight)));
    f.x = hn::MulAdd(k, y_x, f.x);
    f.y = hn::MulAdd(k, y_y, f.y);
    f.z = hn::MulAdd(k, y_z, f.z);
    if constexpr (both) {
      hn::StoreU(hn::NegMulAdd(k, y_x, hn::LoadU(d, others[0] + there)), d, others[0] + there);
      hn::StoreU(hn::NegMulAdd(k, y_y, hn::LoadU(d, others[1] + there)), d, others[1] + there);
      hn::StoreU(hn::NegMulAdd(k, y_z, hn::LoadU(d, others[2] + there)), d, others[2] + there);
    }
    if constexpr (observing) {
      V w = hn::Mul(law.energy_factor(d, t), hn::Set(d, bond.energy_weight));
      if constexpr (heterogeneous) w = hn::Mul(w, stiffness);
      w = hn::IfThenElseZero(pulling, w);
      f.energy = hn::Add(f.energy, w);
      if constexpr (both) hn::StoreU(hn::Add(w, hn::LoadU(d, others[3] + there)), d, others[3] + there);
      const auto crushed = hn::And(pulling, hn::Lt(t, hn::Set(d, Real(-0.75))));
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
  namespace hn = hwy::HWY_NAMESPACE;
  using D = hn::CappedTag<Real, parallel::block_rows>;
  const D d;
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(parallel::block_rows); lane += hn::Lanes(d)) {
    // Apart from the sums in memory: bonds of these rows with each other add to those meanwhile.
    detail::Sums<D> sum{hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (const BondRun run : runs) {
      if (run.both) {
        detail::add_run<true, observing, heterogeneous, wrapped>(d, law, block, lane, run, sum, events);
      } else {
        detail::add_run<false, observing, heterogeneous, wrapped>(d, law, block, lane, run, sum, events);
      }
    }
    const auto add = [&](std::size_t k, hn::Vec<D> value) {
      Real* const at = block.sums[k] + lane;
      hn::StoreU(hn::Add(hn::LoadU(d, at), value), d, at);
    };
    add(0, sum.x);
    add(1, sum.y);
    add(2, sum.z);
    if constexpr (observing) add(3, sum.energy);
  }
}

}  // namespace rhexis::peridynamics
