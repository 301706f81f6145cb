// SPDX-License-Identifier: BSD-3-Clause
/// A rank's bonds: their constants, one bit each that tells whether they are intact, and what follows from
/// those bits.
///
/// A column's family of bonds is the same for all of its rows. Bit k of the word of bond b of a block of 16
/// rows is set while bond b of row k exists and is unbroken. Words stand as [column][block][bond].
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "peridynamics/engine/body.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/engine/domain.hpp"
#include "peridynamics/engine/kernel_units.hpp"
#include "peridynamics/engine/place_properties.hpp"

namespace rhexis::peridynamics {

/// Bits moved up, or down where `up` is negative.
inline unsigned shifted(unsigned bits, int up) {
  return up >= 0 ? bits << up : bits >> -up;
}

template <class Real>
class BondStorage {
 public:
  /// All bonds are intact at first. Keeps pointers to the arguments.
  BondStorage(const Domain& domain, const BondFamilies& families, const KernelUnits& units,
              const PlaceProperties<Real>& properties)
      : domain_(&domain), families_(&families), properties_(&properties) {
    make_constants(units);
    make_words();
    find_opposites();
  }

  /// Memory that this takes on all ranks.
  static double bytes(const BodySize& size) {
    return size.bonds * (sizeof(BondConstants<Real>) + sizeof(std::int32_t)) +
           size.words() * sizeof(std::uint16_t) + size.particles() * sizeof(double) + size.blocks();
  }

  /// Constants of the bonds of an owned column.
  std::span<const BondConstants<Real>> bonds(std::int32_t slot) const {
    return {constants_.data() + first_bond(slot), count(slot)};
  }
  /// The same bonds as their family has them.
  std::span<const Bond> family(std::int32_t slot) const {
    return families_->of(domain_->global_column(slot));
  }
  /// How many bonds the columns before `slot` have.
  std::int64_t first_bond(std::int32_t slot) const { return first_bond_[static_cast<std::size_t>(slot)]; }
  std::size_t count(std::int32_t slot) const {
    return static_cast<std::size_t>(first_bond(slot + 1) - first_bond(slot));
  }
  std::size_t size() const { return constants_.size(); }

  /// Words of a block, one per bond of its column.
  std::uint16_t* words(RowBlock b) { return intact_.data() + first_word(b); }
  const std::uint16_t* words(RowBlock b) const { return intact_.data() + first_word(b); }

  /// Rows of a block, one bit each, in which bond `bond` of its column exists before anything breaks.
  std::uint16_t initial_bonds(RowBlock b, std::size_t bond) const {
    const unsigned rows = domain_->partners(b.block, family(b.slot)[bond].row_offset);
    const unsigned without = properties_->rows_without_ends(domain_->padded(b), bonds(b.slot)[bond].offset);
    return static_cast<std::uint16_t>(rows & ~without);
  }

  /// Rows of a block in which bond `bond` existed at first and is broken.
  std::uint16_t broken(RowBlock b, std::size_t bond) const {
    constexpr std::uint16_t all = 0xFFFF;
    const std::uint16_t word = words(b)[bond];
    return word == all ? std::uint16_t{0} : static_cast<std::uint16_t>(initial_bonds(b, bond) & ~word);
  }

  /// Calls `use(word, row_block, shift)` for the words, at most two, of the other ends of bond `bond` of rows
  /// [row, row + 16) of column `slot` (forward bonds only) whose blocks begin in [first_row, past_row): bit 0
  /// of those rows is bit `shift` of the word, which may be negative.
  template <class Use>
  void each_opposite(std::int32_t slot, std::int64_t row, std::int32_t bond, std::int64_t first_row,
                     std::int64_t past_row, const Use& use) {
    const Bond& reference = family(slot)[static_cast<std::size_t>(bond)];
    const auto there = static_cast<std::int32_t>(domain_->slot(reference.other));
    const auto opposite =
        static_cast<std::size_t>(opposite_[static_cast<std::size_t>(first_bond(slot) + bond)]);
    const std::int64_t row_there = row + reference.row_offset;  // at least -32
    const std::int64_t first = (row_there + 2 * block_rows) / block_rows - 2;
    for (std::int64_t block = first; block <= first + 1; ++block) {
      if (block * block_rows < first_row || block * block_rows >= past_row) continue;
      const RowBlock b{there, static_cast<std::int32_t>(block)};
      use(words(b)[opposite], b, static_cast<int>(row_there - block * block_rows));
    }
  }

  /// Eq. (6), damage of each row of a block: the share of its family's volume that it is no longer bonded to;
  /// 0 for a particle that never had bonds.
  void find_damage(RowBlock b, double (&damage)[block_rows]) const {
    std::fill_n(damage, block_rows, 0.0);
    const auto constants = bonds(b.slot);
    for (std::size_t bond = 0; bond < constants.size(); ++bond) {
      const unsigned rows = broken(b, bond);
      if (rows == 0) continue;
      const double volume = constants[bond].volume;
      for (int lane = 0; lane < block_rows; ++lane) damage[lane] += (rows >> lane & 1u) ? volume : 0.0;
    }
    const double* const whole = family_volume_.data() + domain_->first_particle(b);
    for (int lane = 0; lane < domain_->rows_in(b.block); ++lane)
      damage[lane] = whole[lane] > 0 ? damage[lane] / whole[lane] : 0;
  }

  /// Damage reaches `rupture_damage` somewhere in the block.
  bool has_ruptured(RowBlock b) const {
    double damage[block_rows];
    find_damage(b, damage);
    return *std::max_element(damage, damage + domain_->rows_in(b.block)) >= rupture_damage;
  }

  /// Marks a block whose bonds broke; threads may mark different blocks at once.
  void mark_changed(RowBlock b) { changed_[domain_->number(b)] = for_damage | for_load; }
  /// Whether the block was marked since the last call, or since the start.
  bool take_changed(RowBlock b) { return take(b, for_damage); }
  /// The same, for those who ask for `rows_without_bonds`.
  bool take_loosened(RowBlock b) { return take(b, for_load); }

  /// Rows of a block whose particles have no intact bond, one bit each.
  std::uint16_t rows_without_bonds(RowBlock b) const {
    unsigned held = 0;
    for (std::size_t bond = 0; bond < count(b.slot); ++bond) held |= words(b)[bond];
    return static_cast<std::uint16_t>(~held & 0xffffu);
  }

  /// Directed bonds of owned particles: those that existed at first, and those that are intact.
  std::int64_t initial_count() const { return initial_count_; }
  std::int64_t intact_count() const { return intact_count_; }
  void count_broken(std::int64_t bonds) { intact_count_ -= bonds; }

  /// A row per bond of each column's family, and a word per 16 particles along the axis.
  TablePart word_table() const {
    const ColumnLayout& l = domain_->layout();
    const auto& first = families_->first;
    const std::int64_t row = first[static_cast<std::size_t>(l.first_column)],
                       past = first[static_cast<std::size_t>(l.first_column + l.column_count)];
    TablePart part{.rows = {.global_count = first.back()},
                   .width = (l.rows + block_rows - 1) / block_rows,
                   .first = l.first_row / block_rows,
                   .count = domain_->blocks()};
    part.rows.add({row, past - row});
    return part;
  }

  /// All words in the order of `word_table`.
  std::vector<std::uint16_t> save() const {
    std::vector<std::uint16_t> saved;
    saved.reserve(intact_.size());
    each_saved_place([&](std::size_t place) { saved.push_back(intact_[place]); });
    return saved;
  }

  void restore(std::span<const std::uint16_t> saved) {
    std::ranges::fill(changed_, char{for_damage | for_load});
    auto word = saved.begin();
    each_saved_place([&](std::size_t place) {
      intact_count_ += std::popcount(*word) - std::popcount(intact_[place]);
      intact_[place] = *word++;
    });
  }

 private:
  /// Who has not yet asked whether a block changed.
  static constexpr char for_damage = 1, for_load = 2;
  bool take(RowBlock b, char who) {
    char& changed = changed_[domain_->number(b)];
    const bool was = (changed & who) != 0;
    changed = static_cast<char>(changed & ~who);
    return was;
  }

  std::size_t first_word(RowBlock b) const {
    return static_cast<std::size_t>(first_bond(b.slot) * domain_->blocks()) +
           static_cast<std::size_t>(b.block) * count(b.slot);
  }

  template <class Use>
  void each_saved_place(const Use& use) const {
    for (std::int32_t slot = 0; slot < domain_->layout().column_count; ++slot) {
      for (std::size_t bond = 0; bond < count(slot); ++bond) {
        for (std::int32_t block = 0; block < domain_->blocks(); ++block)
          use(first_word({slot, block}) + bond);
      }
    }
  }

  void make_constants(const KernelUnits& units) {
    const ColumnLayout& layout = domain_->layout();
    const auto& first = families_->first;
    constants_.reserve(
        static_cast<std::size_t>(first[static_cast<std::size_t>(layout.first_column + layout.column_count)] -
                                 first[static_cast<std::size_t>(layout.first_column)]));
    first_bond_.push_back(0);
    for (std::int32_t slot = 0; slot < layout.column_count; ++slot) {
      const double own_volume = units.relative_volume(domain_->global_column(slot));
      const auto own = static_cast<std::int64_t>(domain_->padded(RowBlock{slot, 0}));
      for (const Bond& bond : family(slot)) {
        const double volume = units.relative_volume(static_cast<std::size_t>(bond.other));
        const auto partner =
            static_cast<std::int64_t>(domain_->padded(domain_->slot(bond.other))) + bond.row_offset;
        const double inverse_length2 = 1 / (bond.length * bond.length);
        BondConstants<Real> constants{
            .inverse_length2 = Real(inverse_length2),
            .weight = Real(bond.weight * (own_volume * volume) / bond.length),
            .volume = Real(volume),
            .energy_weight = Real(bond.weight * (own_volume * volume) * bond.length),
            .offset = static_cast<std::int32_t>(partner - own)};
        for (int k = 0; k < 3; ++k) {
          constants.xi[k] = Real(bond.xi[k]);
          constants.twice_xi[k] = Real(2 * bond.xi[k] * inverse_length2);
        }
        constants_.push_back(constants);
      }
      first_bond_.push_back(static_cast<std::int64_t>(constants_.size()));
    }
  }

  void make_words() {
    const ColumnLayout& layout = domain_->layout();
    family_volume_.resize(static_cast<std::size_t>(layout.local_count()));
    intact_.resize(constants_.size() * static_cast<std::size_t>(domain_->blocks()));
    changed_.resize(static_cast<std::size_t>(layout.column_count * domain_->blocks()), for_damage | for_load);
    for (std::int32_t slot = 0; slot < layout.column_count; ++slot) {
      for (std::int32_t block = 0; block < domain_->blocks(); ++block) {
        const RowBlock b{slot, block};
        for (std::size_t bond = 0; bond < count(slot); ++bond) {
          const std::uint16_t word = initial_bonds(b, bond);
          words(b)[bond] = word;
          initial_count_ += std::popcount(word);
          for (unsigned rows = word; rows != 0; rows &= rows - 1)
            family_volume_[domain_->first_particle(b) + static_cast<std::size_t>(std::countr_zero(rows))] +=
                double{bonds(slot)[bond].volume};
        }
      }
    }
    intact_count_ = initial_count_;
  }

  /// Finds each forward bond's number in the family of its other end: among the bonds there that are not
  /// forward, which are sorted (BondFamilies).
  void find_opposites() {
    opposite_.resize(constants_.size(), -1);
    for (std::int32_t slot = 0; slot < domain_->layout().column_count; ++slot) {
      const auto own = static_cast<std::int32_t>(domain_->global_column(slot));
      const std::span<const Bond> bonds = family(slot);
      for (std::size_t b = 0; b < bonds.size(); ++b) {
        const Bond& bond = bonds[b];
        if (!is_forward(bond, own)) continue;
        const std::span<const Bond> there = families_->of(static_cast<std::size_t>(bond.other));
        const auto forward = std::find_if(there.begin(), there.end(),
                                          [&](const Bond& other) { return is_forward(other, bond.other); });
        const auto found =
            std::lower_bound(there.begin(), forward, std::pair(own, -bond.row_offset),
                             [](const Bond& other, const std::pair<std::int32_t, int>& wanted) {
                               return std::pair(other.other, other.row_offset) < wanted;
                             });
        opposite_[static_cast<std::size_t>(first_bond(slot)) + b] =
            static_cast<std::int32_t>(found - there.begin());
      }
    }
  }

  const Domain* domain_;
  const BondFamilies* families_;
  const PlaceProperties<Real>* properties_;
  std::vector<std::int64_t> first_bond_;  ///< where each owned column begins in constants_
  std::vector<BondConstants<Real>> constants_;
  std::vector<std::int32_t> opposite_;  ///< [constants_] place of the same bond seen from its other end, -1
                                        ///< where the bond is not forward
  std::vector<std::uint16_t> intact_;
  std::vector<double> family_volume_;  ///< [owned particles] sum of V_j / spacing^3 of the initial bonds
  std::vector<char> changed_;          ///< [blocks] for_damage, for_load
  std::int64_t initial_count_ = 0, intact_count_ = 0;
};

}  // namespace rhexis::peridynamics
