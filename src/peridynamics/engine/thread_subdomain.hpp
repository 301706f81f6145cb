// SPDX-License-Identifier: BSD-3-Clause
/// The part of a rank's columns and rows whose forces one thread sums.
///
/// Owned columns and blocks are dealt out to threads as the body's are to ranks. A bond to a later column of
/// the subdomain, or up in its own column, is evaluated once for both of its ends; a bond to another
/// subdomain's column is evaluated by each end for itself.
#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/partition.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/engine/bond_storage.hpp"
#include "peridynamics/engine/domain.hpp"

namespace rhexis::peridynamics {

/// Owned columns [first_slot, past_slot) and local rows [first_row, past_row).
struct SubdomainExtent {
  std::int32_t first_slot, past_slot;
  std::int64_t first_row, past_row;

  std::int32_t first_block() const { return static_cast<std::int32_t>(first_row / block_rows); }
  std::int32_t past_block() const {
    return static_cast<std::int32_t>((past_row + block_rows - 1) / block_rows);
  }
  /// First of the 16 rows next to the upper or lower end.
  std::int64_t row_beyond(bool above) const { return above ? past_row : first_row - block_rows; }
};

template <class Real>
class ThreadSubdomain : public SubdomainExtent {
 public:
  ThreadSubdomain(const Domain& domain, const BondStorage<Real>& bonds, const SubdomainExtent& extent)
      : SubdomainExtent(extent), domain_(&domain), first_bond_(bonds.first_bond(first_slot)) {
    std::size_t longest = 0;
    for (std::int32_t slot = first_slot; slot < past_slot; ++slot) {
      first_run_.push_back(runs_.size());
      add_runs(slot, bonds.family(slot));
      longest = std::max(longest, bonds.count(slot));
    }
    first_run_.push_back(runs_.size());
    for (auto& words : words_beyond_)
      words.resize(static_cast<std::size_t>(bonds.first_bond(past_slot) - first_bond_));
    broken.resize(longest * static_cast<std::size_t>(block_rows));
    for (auto& sums : sums_)
      sums = hwy::AllocateAligned<Real>(domain.stride() * static_cast<std::size_t>(past_slot - first_slot));
  }

  /// Memory that the subdomains of all threads and ranks take.
  static double bytes(const BodySize& size) {
    return 4 * size.columns * size.stride() * sizeof(Real) + 2 * size.bonds * sizeof(std::uint16_t);
  }

  /// A column's bonds to columns before the subdomain; may be none.
  const BondRun& backward_run(std::int32_t slot) const { return runs_[first_run(slot)]; }
  /// A column's forward bonds.
  std::span<const BondRun> forward_runs(std::int32_t slot) const {
    return {runs_.data() + first_run(slot) + 1, runs_.data() + first_run(slot + 1)};
  }

  /// Sums of component `k` (0, 1, 2: force; 3: energy, when observing) from local row `row` of a column on,
  /// in the kernel's units.
  Real* sums(std::size_t k, std::int32_t slot, std::int64_t row) const {
    return sums_[k].get() +
           static_cast<std::ptrdiff_t>(domain_->padded(static_cast<std::size_t>(slot - first_slot))) + row;
  }

  /// Words of a column's bonds that lead into the subdomain from the 16 rows below it, or from those above;
  /// 0 for other bonds.
  std::span<std::uint16_t> words_beyond(std::int32_t slot, bool above, const BondStorage<Real>& bonds) {
    return {words_beyond_[above].data() + (bonds.first_bond(slot) - first_bond_), bonds.count(slot)};
  }

  bool beyond_known = false;       ///< words_beyond agree with the bonds' other ends
  std::vector<BrokenBond> broken;  ///< room for the bonds of one block that break for both ends

 private:
  std::size_t first_run(std::int32_t slot) const {
    return first_run_[static_cast<std::size_t>(slot - first_slot)];
  }

  void add_runs(std::int32_t slot, std::span<const Bond> family) {
    const auto first = static_cast<std::int32_t>(domain_->global_column(first_slot));
    const auto past = static_cast<std::int32_t>(domain_->global_column(past_slot - 1)) + 1;
    const auto own = static_cast<std::int32_t>(domain_->global_column(slot));
    const auto bonds = static_cast<std::int32_t>(family.size());
    std::int32_t b = 0;
    while (b < bonds && family[static_cast<std::size_t>(b)].other < first) ++b;
    runs_.push_back({0, b, false, 0});
    const std::size_t start = runs_.size();
    for (; b < bonds; ++b) {
      const Bond& bond = family[static_cast<std::size_t>(b)];
      if (!is_forward(bond, own)) continue;
      const bool both = bond.other < past;
      if (runs_.size() > start && runs_.back().both == both) {
        ++runs_.back().past;
      } else {
        runs_.push_back({b, b + 1, both, 2});
      }
    }
  }

  const Domain* domain_;
  std::int64_t first_bond_;             ///< place of first_slot in the storage
  std::vector<BondRun> runs_;           ///< each column's backward_run, then its forward_runs
  std::vector<std::size_t> first_run_;  ///< where each column begins in runs_
  std::array<hwy::AlignedFreeUniquePtr<Real[]>, 4> sums_;  ///< each column as in padded arrays
  std::array<std::vector<std::uint16_t>, 2> words_beyond_;
};

/// A rank's subdomains, at most one per thread.
template <class Real>
std::vector<ThreadSubdomain<Real>> make_subdomains(const Domain& domain, const BondStorage<Real>& bonds,
                                                   const BondFamilies& families, int threads) {
  const ColumnLayout& layout = domain.layout();
  std::vector<double> weights;
  for (std::int32_t slot = 0; slot < layout.column_count; ++slot)
    weights.push_back(static_cast<double>(bonds.count(slot)));
  const auto count = static_cast<int>(std::min<std::int64_t>(threads, layout.column_count));
  const parallel::Partition split = parallel::make_partition(
      count, weights, layout.row_count, {.bonds_across = mean_column_cut(families).bonds});
  std::vector<ThreadSubdomain<Real>> subdomains;
  subdomains.reserve(static_cast<std::size_t>(count));
  for (int p = 0; p < count; ++p) {
    subdomains.emplace_back(domain, bonds,
                            SubdomainExtent{.first_slot = static_cast<std::int32_t>(split.first_column(p)),
                                            .past_slot = static_cast<std::int32_t>(split.past_column(p)),
                                            .first_row = split.first_row(p),
                                            .past_row = split.past_row(p)});
  }
  return subdomains;
}

}  // namespace rhexis::peridynamics
