/// ColumnBody: forces with each bond evaluated once for both of its ends, where one thread has both.
///
/// Owned columns and blocks are dealt out to threads in parts, as the body's are to ranks. In a part columns
/// are done one after another, each from its first row on. Bonds that lead to later columns of the part, or
/// up in their own, are evaluated for both ends, and their forces added to the sums of the others; those to
/// other parts' columns each end evaluates for itself. The digits are the same either way (bond_kernel.hpp),
/// and each particle adds in the order of its family (bond_family.hpp), what leads later as one sum: parts
/// make no difference.
///
/// Rows beyond a part's ends are in another part, which does not add to this one. Their bonds into the part
/// are evaluated here once more, for the end that is inside.
#pragma once

#include "peridynamics/engine/column_body.hpp"

namespace rhexis::peridynamics {

template <class Law, class Real>
void ColumnBody<Law, Real>::make_parts() {
  const PointLayout& layout = domain_.layout();
  std::vector<double> weights;
  for (std::int32_t slot = 0; slot < layout.column_count; ++slot)
    weights.push_back(static_cast<double>(first_bond_[slot + 1] - first_bond_[slot]));
  const auto count = static_cast<int>(std::min<std::int64_t>(threads_, layout.column_count));
  const parallel::Partition split = parallel::make_partition(
      count, weights, layout.row_count, {.bonds_across = mean_column_cut(*setup_.families).bonds});
  std::size_t longest = 0;
  for (int p = 0; p < count; ++p) {
    Part<Real>& part = parts_.emplace_back();
    part.first_slot = static_cast<std::int32_t>(split.first_column(p));
    part.past_slot = static_cast<std::int32_t>(split.past_column(p));
    part.first_row = split.first_row(p);
    part.past_row = split.past_row(p);
    for (std::int32_t slot = part.first_slot; slot < part.past_slot; ++slot) {
      part.first_run.push_back(part.runs.size());
      add_runs(part, slot);
      longest = std::max(longest, bonds_of({slot, 0}).size());
    }
    part.first_run.push_back(part.runs.size());
    for (auto& words : part.beyond)
      words.resize(static_cast<std::size_t>(first_bond_[part.past_slot] - first_bond_[part.first_slot]));
    part.broken.resize(longest * static_cast<std::size_t>(block_rows));
    for (auto& sums : part.sums)
      sums = hwy::AllocateAligned<Real>(domain_.stride() * (part.first_run.size() - 1));
  }
  find_opposites();
}

/// Numbers of bonds that lead later in the families of their other ends: among the bonds there that do not,
/// which are sorted (BondFamilies).
template <class Law, class Real>
void ColumnBody<Law, Real>::find_opposites() {
  const PointLayout& layout = domain_.layout();
  opposite_.resize(bonds_.size(), -1);
  for (std::int32_t slot = 0; slot < layout.column_count; ++slot) {
    const auto own = static_cast<std::int32_t>(global_column(slot));
    for (std::size_t b = 0; b < bonds_of({slot, 0}).size(); ++b) {
      const Bond& bond = reference_bond({slot, 0}, b);
      if (!leads_later(bond, own)) continue;
      const std::span<const Bond> family = setup_.families->of(static_cast<std::size_t>(bond.other));
      const auto earlier = std::find_if(family.begin(), family.end(),
                                        [&](const Bond& other) { return leads_later(other, bond.other); });
      const auto found = std::lower_bound(family.begin(), earlier, std::pair(own, -bond.row_offset),
                                          [](const Bond& other, const std::pair<std::int32_t, int>& wanted) {
                                            return std::pair(other.other, other.row_offset) < wanted;
                                          });
      opposite_[static_cast<std::size_t>(first_bond_[slot]) + b] =
          static_cast<std::int32_t>(found - family.begin());
    }
  }
}

/// Of a column: its bonds to columns before the part, be there any or not, then those that lead later.
template <class Law, class Real>
void ColumnBody<Law, Real>::add_runs(Part<Real>& part, std::int32_t slot) const {
  const auto first = static_cast<std::int32_t>(global_column(part.first_slot));
  const auto past = static_cast<std::int32_t>(global_column(part.past_slot - 1)) + 1;
  const auto own = static_cast<std::int32_t>(global_column(slot));
  const std::span<const Bond> family = setup_.families->of(static_cast<std::size_t>(own));
  const auto bonds = static_cast<std::int32_t>(family.size());
  std::int32_t b = 0;
  while (b < bonds && family[static_cast<std::size_t>(b)].other < first) ++b;
  part.runs.push_back({0, b, false, 0});
  const std::size_t start = part.runs.size();
  for (; b < bonds; ++b) {
    const Bond& bond = family[static_cast<std::size_t>(b)];
    if (!leads_later(bond, own)) continue;
    const bool both = bond.other < past;
    if (part.runs.size() > start && part.runs.back().both == both) {
      ++part.runs.back().past;
    } else {
      part.runs.push_back({b, b + 1, both, 2});
    }
  }
}

/// Bits moved up, or down where `up` is negative.
inline unsigned shifted(unsigned bits, int up) {
  return up >= 0 ? bits << up : bits >> -up;
}

/// Calls `use(word, unit, shift)` for the words in the part, at most two, of the other ends of bond `b` of
/// rows [row, row + 16) of a column: bit 0 of those rows is bit `shift` of the word, which may be negative.
template <class Law, class Real>
template <class Use>
void ColumnBody<Law, Real>::each_opposite(const Part<Real>& part, std::int32_t slot, std::int64_t row,
                                          std::int32_t b, const Use& use) {
  const Bond& bond = reference_bond({slot, 0}, static_cast<std::size_t>(b));
  const auto there = static_cast<std::int32_t>(domain_.slot(bond.other));
  const auto number = static_cast<std::size_t>(opposite_[static_cast<std::size_t>(first_bond_[slot] + b)]);
  const std::int64_t row_there = row + bond.row_offset;  // at least -32
  const std::int64_t first = (row_there + 2 * block_rows) / block_rows - 2;
  for (std::int64_t block = first; block <= first + 1; ++block) {
    if (block * block_rows < part.first_row || block * block_rows >= part.past_row) continue;
    const Unit unit{there, static_cast<std::int32_t>(block)};
    use(intact_[first_word(unit) + number], unit, static_cast<int>(row_there - block * block_rows));
  }
}

/// Breaks the first `count` of `part.broken`, bonds of rows [row, row + 16) of a column, at their other ends
/// in the part.
template <class Law, class Real>
void ColumnBody<Law, Real>::break_other_ends(Part<Real>& part, std::int32_t slot, std::int64_t row,
                                             std::size_t count, ThreadEvents& events) {
  for (std::size_t i = 0; i < count; ++i) {
    const BrokenBond broken = part.broken[i];
    each_opposite(part, slot, row, broken.bond, [&](std::uint16_t& word, Unit unit, int shift) {
      const auto ending = static_cast<std::uint16_t>(word & shifted(broken.rows, shift));
      word = static_cast<std::uint16_t>(word & ~ending);
      note_broken(unit, std::popcount(ending), events);
    });
  }
}

/// Finds `part.beyond` of one of its ends from the words of the bonds' other ends, which are in the part.
template <class Law, class Real>
void ColumnBody<Law, Real>::find_beyond(Part<Real>& part, bool above) {
  std::ranges::fill(part.beyond[above], std::uint16_t{0});
  for (std::int32_t slot = part.first_slot; slot < part.past_slot; ++slot) {
    std::uint16_t* const words = words_beyond(part, slot, above);
    for (const BondRun run : part.runs_from(slot)) {
      for (std::int32_t b = run.first; run.both && b < run.past; ++b) {
        const int up = reference_bond({slot, 0}, static_cast<std::size_t>(b)).row_offset;
        if (above ? up >= 0 : up <= 0) continue;
        unsigned rows = 0;
        each_opposite(part, slot, part.row_beyond(above), b,
                      [&](std::uint16_t there, Unit, int shift) { rows |= shifted(there, -shift); });
        words[b] = static_cast<std::uint16_t>(rows);
      }
    }
  }
}

/// Bonds from a column's rows beyond the part into it.
template <class Law, class Real>
template <bool observing>
void ColumnBody<Law, Real>::add_from_beyond(Part<Real>& part, std::int32_t slot, bool above,
                                            ThreadEvents& events) {
  const std::int64_t row = part.row_beyond(above);
  const BlockEvents found =
      sum<observing>(view(part, slot, row, words_beyond(part, slot, above)), part.runs_from(slot));
  break_other_ends(part, slot, row, found.broken_for_both, events);
}

/// Sums the forces of a part's particles, and their energies when observing, in `part.sums`; calls
/// `use(slot)` for each column once it is done.
template <class Law, class Real>
template <bool observing, class Use>
void ColumnBody<Law, Real>::sum_part(Part<Real>& part, ThreadEvents& events, const Use& use) {
  const PointLayout& layout = domain_.layout();
  const bool below = periodic_ || layout.first_row + part.first_row > 0;
  const bool above = periodic_ || layout.first_row + part.past_row < layout.rows;
  if (!std::exchange(part.beyond_known, true)) {
    if (below) find_beyond(part, false);
    if (above) find_beyond(part, true);
  }
  const std::int32_t first_block = part.first_block(), past_block = part.past_block();
  const auto add_block = [&](Unit unit, std::span<const BondRun> runs) {
    const BlockView<Real> here =
        view(part, unit.slot, unit.block * block_rows, intact_.data() + first_word(unit));
    const BlockEvents found = sum<observing>(here, runs);
    note_broken(unit, found.broken, events);
    break_other_ends(part, unit.slot, unit.block * block_rows, found.broken_for_both, events);
    events.crushed += found.crushed;
  };
  for (std::int32_t slot = part.first_slot; slot < part.past_slot; ++slot) {
    const BondRun& before = part.run_before(slot);
    // Of rows beyond the part, to which bonds across its ends add, nobody reads the sums.
    const BlockView<Real> below_part = view(part, slot, part.first_row - block_rows, nullptr);
    for (std::size_t k = 0; k < (observing ? 4 : 3); ++k)
      std::fill_n(below_part.sums[k], (past_block - first_block + 2) * block_rows, Real{0});
    for (std::int32_t block = first_block; before.past > 0 && block < past_block; ++block)
      add_block({slot, block}, {&before, 1});
  }
  for (std::int32_t slot = part.first_slot; slot < part.past_slot; ++slot) {
    if (below) add_from_beyond<observing>(part, slot, false, events);
    for (std::int32_t block = first_block; block < past_block; ++block)
      add_block({slot, block}, part.runs_from(slot));
    use(slot);
    if (above) add_from_beyond<observing>(part, slot, true, events);
  }
}

}  // namespace rhexis::peridynamics
