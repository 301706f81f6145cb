// SPDX-License-Identifier: BSD-3-Clause
/// The inner loop that a state-based law runs before the forces' (bond_kernel.hpp): extensions of each
/// particle's family. Each end of a bond evaluates it for itself and breaks it here, in the same step.
#pragma once

#include "peridynamics/engine/bond_kernel.hpp"

namespace rhexis::peridynamics {

/// Sums over each row's family of w V_i V_j e / spacing^7.
template <class Real>
struct ExtensionSums {
  alignas(64) Real intact[parallel::block_rows];
  alignas(64) Real lost[parallel::block_rows];  ///< what bonds that broke in this step have lost
  int broken = 0;                               ///< directed bonds that broke now
};

/// Breaks what is stretched too far, then sums the extensions of what is left.
template <bool heterogeneous, bool wrapped, class Real>
HWY_INLINE void sum_extensions(const BlockView<Real>& block, ExtensionSums<Real>& sums) {
  using D = hn::CappedTag<Real, parallel::block_rows>;
  using X = Lanes<D>;
  const D d;
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(parallel::block_rows); lane += hn::Lanes(d)) {
    const detail::Ends<wrapped, D, Real> ends(block, lane);
    const detail::BreakingTest<heterogeneous, D, Real> test(block, lane);
    X intact = Real{0}, lost = Real{0};
    std::uint16_t* words = block.intact;
    for (const BondConstants<Real>& bond : block.bonds) {
      std::uint16_t& word = *words++;
      if (word == 0) continue;
      const X t = ends.deformed(bond).t;
      const X extension = stretch(t) * bond.energy_weight;
      const std::uint16_t broken = detail::clear(d, test.fails(bond, t), lane, word);
      if (HWY_UNLIKELY(broken != 0)) {
        sums.broken += std::popcount(broken);
        lost = lost + where(detail::lanes_of(d, broken, lane), extension);
      }
      intact = intact + where(detail::lanes_of(d, word, lane), extension);
    }
    intact.store(sums.intact + lane);
    lost.store(sums.lost + lane);
  }
}

}  // namespace rhexis::peridynamics
