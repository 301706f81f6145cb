// SPDX-License-Identifier: BSD-3-Clause
/// Properties of a wall that differ from place to place, on a rank's particles and its halo. They are pure
/// functions of the reference position, so that no rank needs to ask another.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "parallel/threads.hpp"
#include "peridynamics/engine/body_setup.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/engine/domain.hpp"

namespace rhexis::peridynamics {

template <class Real>
class PlaceProperties {
 public:
  PlaceProperties(const BodySetup& setup, const Domain& domain, int threads) {
    const RowHeights heights = row_heights(setup, domain);
    if (!setup.heterogeneity.uniform()) find_factors(setup, domain, heights, threads);
    if (!setup.thin_spots.none()) find_absent(setup, domain, heights);
  }

  /// Memory that this takes on all ranks.
  static double bytes(const BodySize& size) {
    return size.padded() * ((size.heterogeneous ? 2 * sizeof(Real) : 0) + (size.thinned ? sizeof(char) : 0));
  }

  /// Critical stretch and stiffness are the same everywhere.
  bool uniform() const { return half_stretch_.empty(); }

  /// What the kernel reads from index `padded` on; null where the wall is uniform.
  LocalProperties<Real> at(std::size_t padded) const {
    if (uniform()) return {};
    return {half_stretch_.data() + padded, half_stiffness_.data() + padded};
  }

  /// Factor on the stiffness of the particle at index `padded`.
  double stiffness(std::size_t padded) const { return uniform() ? 1 : 2 * double{half_stiffness_[padded]}; }

  /// Critical stretch of a bond between two particles of a wall that is not uniform.
  double bond_stretch(std::size_t here, std::size_t there) const {
    return double{half_stretch_[here]} + double{half_stretch_[there]};
  }
  /// Factor on the stiffness of a bond between two particles of a wall that is not uniform.
  double bond_stiffness(std::size_t here, std::size_t there) const {
    return double{half_stiffness_[here]} + double{half_stiffness_[there]};
  }

  /// Thin spots leave no particle at index `padded`.
  bool is_absent(std::size_t padded) const { return !absent_.empty() && absent_[padded] != 0; }

  /// The rows, one bit each, in which a bond of the 16 particles from index `padded` on to those `offset`
  /// further lacks an end.
  std::uint16_t rows_without_ends(std::size_t padded, std::int32_t offset) const {
    if (absent_.empty()) return 0;
    const char* const here = absent_.data() + padded;
    const char* const there = here + offset;
    unsigned rows = 0;
    for (int lane = 0; lane < block_rows; ++lane) rows |= (here[lane] || there[lane] ? 1u : 0u) << lane;
    return static_cast<std::uint16_t>(rows);
  }

 private:
  /// Heights (m) of all rows that are here, halo included; `first` is the first one's distance in rows from
  /// the first owned row, 0 or negative.
  struct RowHeights {
    std::int64_t first;
    std::vector<double> z;
  };

  static RowHeights row_heights(const BodySetup& setup, const Domain& domain) {
    const ColumnLayout& l = domain.layout();
    const std::int64_t reach = setup.families->reach;
    const std::int64_t below = domain.periodic() ? reach : std::min(reach, l.first_row);
    const std::int64_t past = l.row_count + reach;
    const std::int64_t above = domain.periodic() ? past : std::min(past, l.rows - l.first_row);
    std::vector<double> z;
    for (std::int64_t row = -below; row < above; ++row)
      z.push_back(setup.lattice.height((l.first_row + row + l.rows) % l.rows));
    return {-below, std::move(z)};
  }

  void find_factors(const BodySetup& setup, const Domain& domain, const RowHeights& heights, int threads) {
    half_stretch_.resize(domain.padded_size());
    half_stiffness_.resize(domain.padded_size());
    const CrossSection& section = setup.lattice.section;
    const auto columns = domain.columns();
    parallel::for_each_share(threads, columns.size(), [&](int, std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) {
        const auto c = static_cast<std::size_t>(columns[slot]);
        const auto factors = setup.heterogeneity.along(section.x[c], section.y[c], heights.z);
        const std::size_t first = domain.padded(slot) + static_cast<std::size_t>(heights.first);
        for (std::size_t i = 0; i < factors.size(); ++i) {
          half_stretch_[first + i] =
              static_cast<Real>(0.5 * setup.critical_stretch * factors[i].critical_stretch);
          half_stiffness_[first + i] = static_cast<Real>(0.5 * factors[i].stiffness);
        }
      }
    });
  }

  void find_absent(const BodySetup& setup, const Domain& domain, const RowHeights& heights) {
    absent_.resize(domain.padded_size());
    const CrossSection& section = setup.lattice.section;
    const auto columns = domain.columns();
    for (std::size_t slot = 0; slot < columns.size(); ++slot) {
      const auto c = static_cast<std::size_t>(columns[slot]);
      char* absent = absent_.data() + domain.padded(slot) + heights.first;
      for (const double z : heights.z)
        *absent++ = setup.thin_spots.present(section.x[c], section.y[c], z) ? 0 : 1;
    }
  }

  std::vector<Real> half_stretch_, half_stiffness_;  ///< padded (see LocalProperties); empty: a uniform wall
  std::vector<char> absent_;  ///< padded, 1 where thin spots leave no particle; empty: nowhere
};

}  // namespace rhexis::peridynamics
