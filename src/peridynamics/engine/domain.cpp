// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/engine/domain.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

namespace rhexis::peridynamics {
namespace {

/// Bits [low, high) of a word.
std::uint16_t bit_range(std::int64_t low, std::int64_t high) {
  low = std::clamp<std::int64_t>(low, 0, block_rows);
  high = std::clamp<std::int64_t>(high, 0, block_rows);
  return low >= high ? std::uint16_t{0} : static_cast<std::uint16_t>(((1u << (high - low)) - 1u) << low);
}

/// For each column the columns near its nodes of the lumen and near the neighbours of these, of which a
/// pressure that follows the wall makes the column's load; empty where it is dead.
std::vector<std::vector<std::int32_t>> columns_beside(const LumenSurface& lumen, std::size_t columns) {
  std::vector<std::vector<std::int32_t>> beside(lumen.none() ? 0 : columns);
  for (std::int32_t t = 0; t < lumen.size(); ++t) {
    for (const LumenSurface::Member& here : lumen.of(t)) {
      for (const std::int32_t node : {lumen.previous(t), t, lumen.next(t)}) {
        for (const LumenSurface::Member& there : lumen.of(node))
          beside[static_cast<std::size_t>(here.column)].push_back(there.column);
      }
    }
  }
  return beside;
}

}  // namespace

Domain::Domain(const Lattice& lattice, const BondFamilies& families, const parallel::Partition& partition,
               int rank, bool periodic, const LumenSurface& lumen)
    : families_(&families),
      beside_(columns_beside(lumen, lattice.section.size())),
      partition_(partition),
      rank_(rank),
      periodic_(periodic),
      reach_(families.reach) {
  layout_.columns = static_cast<std::int64_t>(lattice.section.size());
  layout_.rows = lattice.rows;
  layout_.first_column = partition.first_column(rank);
  layout_.column_count = partition.past_column(rank) - layout_.first_column;
  layout_.first_row = partition.first_row(rank);
  layout_.row_count = partition.past_row(rank) - layout_.first_row;

  // A cache line of rows in front keeps owned rows aligned and holds the halo rows.
  if (reach_ > block_rows)
    throw std::invalid_argument("bonds reach " + std::to_string(reach_) + " rows; a halo has room for " +
                                std::to_string(block_rows));
  front_ = block_rows;
  stride_ = front_ + static_cast<std::size_t>((blocks() + 1) * block_rows);
  // Strides that are a multiple of a page would map all columns to the same cache sets.
  if (stride_ % 256 == 0) stride_ += block_rows;

  slot_of_.assign(layout_.columns, -1);
  for (std::int64_t c = 0; c < layout_.column_count; ++c) {
    slot_column_.push_back(static_cast<std::int32_t>(layout_.first_column + c));
  }
  for (std::int32_t c : halo_columns(rank)) slot_column_.push_back(c);
  for (std::size_t s = 0; s < slot_column_.size(); ++s)
    slot_of_[slot_column_[s]] = static_cast<std::int32_t>(s);
  for (std::int64_t c = 0; c < layout_.column_count; ++c) {
    const auto column = static_cast<std::size_t>(layout_.first_column + c);
    all_neighbours_owned_.push_back(std::all_of(
        families.bonds.begin() + families.first[column], families.bonds.begin() + families.first[column + 1],
        [&](const Bond& bond) { return slot_of_[bond.other] < layout_.column_count; }));
  }
}

int Domain::rows_in(std::int64_t block) const {
  return static_cast<int>(std::min(block_rows, layout_.row_count - block * block_rows));
}

std::uint16_t Domain::partners(std::int64_t block, int row_offset) const {
  const std::int64_t first = layout_.first_row + block * block_rows;
  const std::uint16_t rows = bit_range(0, rows_in(block));
  if (periodic_) return rows;
  return rows & bit_range(-row_offset - first, layout_.rows - row_offset - first);
}

bool Domain::interior(std::size_t column_slot, std::int64_t block) const {
  if (!all_neighbours_owned_[column_slot]) return false;
  const std::int64_t first = layout_.first_row + block * block_rows;
  const std::int64_t past = first + rows_in(block);
  const bool needs_below = periodic_ || layout_.first_row > 0;
  const bool needs_above = periodic_ || layout_.first_row + layout_.row_count < layout_.rows;
  return !(needs_below && first - reach_ < layout_.first_row) &&
         !(needs_above && past + reach_ > layout_.first_row + layout_.row_count);
}

std::vector<std::int32_t> Domain::halo_columns(int rank) const {
  const std::int64_t first = partition_.first_column(rank), past = partition_.past_column(rank);
  std::vector<std::int32_t> columns;
  for (std::int64_t b = families_->first[first]; b < families_->first[past]; ++b) {
    const std::int32_t other = families_->bonds[b].other;
    if (other < first || other >= past) columns.push_back(other);
  }
  for (std::int64_t c = first; !beside_.empty() && c < past; ++c) {
    for (const std::int32_t other : beside_[static_cast<std::size_t>(c)]) {
      if (other < first || other >= past) columns.push_back(other);
    }
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  return columns;
}

std::vector<Domain::Needed> Domain::needed_by(int rank) const {
  const std::int64_t first = partition_.first_row(rank), past = partition_.past_row(rank);
  std::vector<Needed> needed;
  const auto add_row = [&](std::int32_t column, std::int64_t halo_row) {
    std::int64_t row = halo_row;
    if (periodic_) row = (row + partition_.rows) % partition_.rows;
    if (row < 0 || row >= partition_.rows) return;
    const int owner = partition_.rank_of(column, row);
    if (!needed.empty()) {
      Needed& last = needed.back();
      if (last.column == column && last.owner == owner && last.halo_row + last.count == halo_row &&
          last.first_row + last.count == row) {
        ++last.count;
        return;
      }
    }
    needed.push_back({column, row, 1, halo_row, owner});
  };
  for (std::int64_t c = partition_.first_column(rank); c < partition_.past_column(rank); ++c) {
    for (std::int64_t row = first - reach_; row < first; ++row) add_row(static_cast<std::int32_t>(c), row);
    for (std::int64_t row = past; row < past + reach_; ++row) add_row(static_cast<std::int32_t>(c), row);
  }
  for (std::int32_t c : halo_columns(rank)) {
    for (std::int64_t row = first - reach_; row < past + reach_; ++row) add_row(c, row);
  }
  return needed;
}

std::vector<parallel::HaloMessage> Domain::halo_messages() const {
  std::map<int, parallel::HaloMessage> messages;
  const auto message = [&](int rank) -> parallel::HaloMessage& {
    messages[rank].rank = rank;
    return messages[rank];
  };
  const auto run = [&](const Needed& n, std::int64_t row) {
    return parallel::Run{padded(slot(n.column)) + static_cast<std::size_t>(row - layout_.first_row),
                         static_cast<std::size_t>(n.count)};
  };
  std::vector<int> partners_here;
  for (const Needed& n : needed_by(rank_)) {
    message(n.owner).receive.push_back(run(n, n.halo_row));
    partners_here.push_back(n.owner);
  }
  // Who reads from whom is symmetric, so the ranks that this one receives from are those it sends to.
  std::sort(partners_here.begin(), partners_here.end());
  partners_here.erase(std::unique(partners_here.begin(), partners_here.end()), partners_here.end());
  for (int reader : partners_here) {
    for (const Needed& n : needed_by(reader)) {
      if (n.owner == rank_) message(reader).send.push_back(run(n, n.first_row));
    }
  }
  std::vector<parallel::HaloMessage> result;
  for (auto& [rank, m] : messages) result.push_back(std::move(m));
  return result;
}

}  // namespace rhexis::peridynamics
