// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/partition.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "core/error.hpp"

namespace rhexis::parallel {
namespace {

/// Part that holds `item`, given the parts' starts.
int part_of(const std::vector<std::int64_t>& start, std::int64_t item) {
  return static_cast<int>(std::upper_bound(start.begin(), start.end(), item) - start.begin()) - 1;
}

/// Starts of `parts` contiguous parts of near-equal weight, none empty.
std::vector<std::int64_t> split(std::span<const double> weights, int parts) {
  const auto count = static_cast<std::int64_t>(weights.size());
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<std::int64_t> start{0};
  double before = 0;
  std::int64_t item = 0;
  for (int part = 1; part < parts; ++part) {
    const double target = total * part / parts;
    while (item < count - (parts - part) && (item <= start.back() || before + weights[item] / 2 < target)) {
      before += weights[item++];
    }
    start.push_back(item);
  }
  start.push_back(count);
  return start;
}

double heaviest(std::span<const double> weights, const std::vector<std::int64_t>& start) {
  double most = 0;
  for (std::size_t p = 0; p + 1 < start.size(); ++p) {
    most = std::max(most, std::accumulate(weights.begin() + start[p], weights.begin() + start[p + 1], 0.0));
  }
  return most;
}

}  // namespace

int Partition::column_part_of(std::int64_t column) const {
  return part_of(column_start, column);
}

int Partition::block_part_of_row(std::int64_t row) const {
  return part_of(block_start, row / block_rows);
}

std::int64_t Partition::past_row(int rank) const {
  return std::min(rows, block_start[rank / column_parts() + 1] * block_rows);
}

Partition make_partition(int ranks, std::span<const double> column_weights, std::int64_t rows,
                         const CutCosts& cut) {
  // Packing, sending and unpacking a halo particle costs about as much as this many bonds.
  constexpr double bonds_per_halo_particle = 10;
  // Bonds into a part from rows beyond its end are evaluated there once more, 16 rows at a time.
  constexpr double blocks_beyond_end = 0.7;
  const auto columns = static_cast<int>(column_weights.size());
  const auto blocks = static_cast<int>((rows + block_rows - 1) / block_rows);
  const std::vector<double> block_weights(blocks, 1.0);
  Partition best;
  double least = 0;
  for (int block_parts = 1; block_parts <= ranks; ++block_parts) {
    const int column_parts = ranks / block_parts;
    if (column_parts * block_parts != ranks || block_parts > blocks || column_parts > columns) continue;
    Partition candidate{split(column_weights, column_parts), split(block_weights, block_parts), rows};
    const double cuts = column_parts > 1 ? 2 : 0, ends = std::min(2, block_parts - 1);  // of one part
    const double own_rows = heaviest(block_weights, candidate.block_start) * block_rows;
    const double own_columns = static_cast<double>(columns) / column_parts;
    const double bonds = heaviest(column_weights, candidate.column_start) *
                             (own_rows + blocks_beyond_end * block_rows * ends) +
                         cut.bonds_across * cuts * own_rows;
    const double halo = cut.halo_columns * cuts * own_rows + cut.halo_rows * ends * own_columns;
    const double cost = bonds + bonds_per_halo_particle * halo;
    if (best.column_start.empty() || cost < least) {
      best = candidate;
      least = cost;
    }
  }
  if (best.column_start.empty()) {
    throw InputError("the vessel's " + std::to_string(columns) + " columns x " + std::to_string(blocks) +
                     " blocks of 16 rows cannot be dealt out to " + std::to_string(ranks) +
                     " ranks; use fewer ranks");
  }
  return best;
}

}  // namespace rhexis::parallel
