// SPDX-License-Identifier: BSD-3-Clause
/// Forces of a rank's bonds (Eq. 1), subdomain by subdomain (thread_subdomain.hpp).
///
/// In a subdomain columns are done one after another, each from its first row on. Forward bonds within the
/// subdomain are evaluated for both ends, and their forces added to the sums of the other ends. The digits
/// are the same as where each end evaluates a bond for itself (bond_kernel.hpp), and each particle adds in
/// the order of its family (bond_family.hpp), its forward bonds as one sum: how subdomains are cut makes no
/// difference.
///
/// Rows beyond a subdomain's ends belong to another one, which does not add to this one. Their bonds into
/// this subdomain are evaluated here once more, for the end that is inside.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "parallel/exact_sum.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/engine/bond_storage.hpp"
#include "peridynamics/engine/following_frame.hpp"
#include "peridynamics/engine/place_properties.hpp"
#include "peridynamics/engine/thread_subdomain.hpp"

namespace rhexis::peridynamics {

/// What a thread gathers during a step; in cache lines of its own, which are fetched in pairs.
struct alignas(128) ThreadEvents {
  explicit ThreadEvents(double energy_scale) : work(energy_scale), released(energy_scale) {}

  parallel::ExactSum work;              ///< J, done by the pressure
  parallel::ExactSum released;          ///< J, energy of dilatation that breaking bonds released
  std::int64_t broken = 0;              ///< directed bonds that broke
  std::int64_t crushed = 0;             ///< directed bonds shorter than half their length; when observing
  std::vector<RowBlock> broken_blocks;  ///< blocks that have an end of a broken bond
  bool damaged = false, unstable = false;

  /// Notes `bonds` broken directed bonds of a block.
  template <class Real>
  void note_broken(RowBlock b, int bonds, BondStorage<Real>& storage) {
    if (bonds == 0) return;
    broken += bonds;
    broken_blocks.push_back(b);
    storage.mark_changed(b);
  }
};

/// What the kernels of one body read, apart from the law.
template <class Real>
struct KernelInput {
  const Domain& domain;
  const BondStorage<Real>& bonds;
  const PlaceProperties<Real>& properties;
  const BondDisplacement<Real>& displacement;
  Real breaking_t;       ///< Eq. (5) of a uniform wall
  const Real* pressure;  ///< padded, of a state-based law; else null

  /// The 16 rows from local row `row` of a column on, with the intact bits `words` of its bonds.
  BlockView<Real> view(std::int32_t slot, std::int64_t row, std::uint16_t* words) const {
    const std::size_t place = domain.padded(static_cast<std::size_t>(slot)) + static_cast<std::size_t>(row);
    const auto u = displacement.current();
    return {.u = {u[0] + place, u[1] + place, u[2] + place},
            .bonds = bonds.bonds(slot),
            .intact = words,
            .breaking_t = breaking_t,
            .local = properties.at(place),
            .pressure = pressure == nullptr ? nullptr : pressure + place};
  }

  /// Calls `use<heterogeneous, wrapped>()` as the wall's properties and its displacements ask for.
  template <class Use>
  void choose_kernel(const Use& use) const {
    const bool wrapped = displacement.frame().wrapped();
    if (properties.uniform()) {
      wrapped ? use.template operator()<false, true>() : use.template operator()<false, false>();
    } else {
      wrapped ? use.template operator()<true, true>() : use.template operator()<true, false>();
    }
  }
};

template <class Law, class Real>
class BondForces {
 public:
  using Subdomain = ThreadSubdomain<Real>;

  /// `bonds` is that of `input`, to break them.
  BondForces(const Law& law, const KernelInput<Real>& input, BondStorage<Real>& bonds,
             const BondFamilies& families, int threads)
      : law_(law),
        input_(input),
        bonds_(&bonds),
        subdomains_(make_subdomains(input.domain, bonds, families, threads)) {}

  std::vector<Subdomain>& subdomains() { return subdomains_; }

  /// To be called when the storage's words were restored.
  void forget_words_beyond() {
    for (Subdomain& s : subdomains_) s.beyond_known = false;
  }

  /// Breaks what is stretched too far, then sums the forces of a subdomain's particles, and their energies
  /// when observing, in its `sums`. Calls `use(slot)` for each column once its sums are complete.
  template <bool observing, class Use>
  void sum(Subdomain& s, ThreadEvents& events, const Use& use) {
    const ColumnLayout& layout = input_.domain.layout();
    const bool below = input_.domain.periodic() || layout.first_row + s.first_row > 0;
    const bool above = input_.domain.periodic() || layout.first_row + s.past_row < layout.rows;
    if (!std::exchange(s.beyond_known, true)) {
      if (below) find_words_beyond(s, false);
      if (above) find_words_beyond(s, true);
    }
    for (std::int32_t slot = s.first_slot; slot < s.past_slot; ++slot) {
      // Nobody reads the sums of rows beyond the subdomain, to which bonds across its ends add.
      const std::int64_t rows = (s.past_block() - s.first_block() + 2) * block_rows;
      for (std::size_t k = 0; k < (observing ? 4 : 3); ++k)
        std::fill_n(s.sums(k, slot, s.first_row - block_rows), rows, Real{0});
      const BondRun& backward = s.backward_run(slot);
      for (std::int32_t block = s.first_block(); backward.past > 0 && block < s.past_block(); ++block)
        sum_rows<observing>(s, {slot, block}, {&backward, 1}, events);
    }
    for (std::int32_t slot = s.first_slot; slot < s.past_slot; ++slot) {
      if (below) sum_from_beyond<observing>(s, slot, false, events);
      for (std::int32_t block = s.first_block(); block < s.past_block(); ++block)
        sum_rows<observing>(s, {slot, block}, s.forward_runs(slot), events);
      use(slot);
      if (above) sum_from_beyond<observing>(s, slot, true, events);
    }
  }

 private:
  template <bool observing>
  BlockEvents run_kernel(Subdomain& s, std::int32_t slot, std::int64_t row, std::uint16_t* words,
                         std::span<const BondRun> runs) const {
    BlockView<Real> block = input_.view(slot, row, words);
    for (std::size_t k = 0; k < 4; ++k) block.sums[k] = s.sums(k, slot, row);
    block.broken = s.broken.data();
    BlockEvents events;
    input_.choose_kernel([&]<bool heterogeneous, bool wrapped>() {
      sum_block<observing, heterogeneous, wrapped>(law_, block, runs, events);
    });
    return events;
  }

  /// Sums `runs` of a block's bonds.
  template <bool observing>
  void sum_rows(Subdomain& s, RowBlock b, std::span<const BondRun> runs, ThreadEvents& events) {
    const std::int64_t row = b.block * block_rows;
    const BlockEvents found = run_kernel<observing>(s, b.slot, row, bonds_->words(b), runs);
    events.note_broken(b, found.broken, *bonds_);
    break_other_ends(s, b.slot, row, found.broken_for_both, events);
    events.crushed += found.crushed;
  }

  /// Sums the bonds that lead from a column's rows beyond an end of the subdomain into it.
  template <bool observing>
  void sum_from_beyond(Subdomain& s, std::int32_t slot, bool above, ThreadEvents& events) {
    const std::int64_t row = s.row_beyond(above);
    std::uint16_t* const words = s.words_beyond(slot, above, *bonds_).data();
    const BlockEvents found = run_kernel<observing>(s, slot, row, words, s.forward_runs(slot));
    break_other_ends(s, slot, row, found.broken_for_both, events);
  }

  /// Breaks the first `count` of `s.broken`, bonds of rows [row, row + 16) of a column, at their other ends
  /// in the subdomain.
  void break_other_ends(Subdomain& s, std::int32_t slot, std::int64_t row, std::size_t count,
                        ThreadEvents& events) {
    for (std::size_t i = 0; i < count; ++i) {
      const BrokenBond broken = s.broken[i];
      const auto break_end = [&](std::uint16_t& word, RowBlock there, int shift) {
        const auto ending = static_cast<std::uint16_t>(word & shifted(broken.rows, shift));
        word = static_cast<std::uint16_t>(word & ~ending);
        events.note_broken(there, std::popcount(ending), *bonds_);
      };
      bonds_->each_opposite(slot, row, broken.bond, s.first_row, s.past_row, break_end);
    }
  }

  /// Finds the words beyond one end of the subdomain from those of the bonds' other ends, which are inside.
  void find_words_beyond(Subdomain& s, bool above) {
    for (std::int32_t slot = s.first_slot; slot < s.past_slot; ++slot) {
      const std::span<std::uint16_t> words = s.words_beyond(slot, above, *bonds_);
      std::ranges::fill(words, std::uint16_t{0});
      const std::span<const Bond> family = bonds_->family(slot);
      for (const BondRun run : s.forward_runs(slot)) {
        for (std::int32_t b = run.first; run.both && b < run.past; ++b) {
          const int up = family[static_cast<std::size_t>(b)].row_offset;
          if (above ? up >= 0 : up <= 0) continue;
          unsigned rows = 0;
          bonds_->each_opposite(
              slot, s.row_beyond(above), b, s.first_row, s.past_row,
              [&](std::uint16_t there, RowBlock, int shift) { rows |= shifted(there, -shift); });
          words[static_cast<std::size_t>(b)] = static_cast<std::uint16_t>(rows);
        }
      }
    }
  }

  Law law_;
  KernelInput<Real> input_;
  BondStorage<Real>* bonds_;
  std::vector<Subdomain> subdomains_;
};

}  // namespace rhexis::peridynamics
