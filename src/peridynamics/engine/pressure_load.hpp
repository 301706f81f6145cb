// SPDX-License-Identifier: BSD-3-Clause
/// The pressure on a rank's particles: Eq. (8)'s layer, times a share that differs along the axis and over
/// thin spots.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "parallel/communicator.hpp"
#include "peridynamics/engine/body_setup.hpp"
#include "peridynamics/engine/domain.hpp"

namespace rhexis::peridynamics {

class PressureLoad {
 public:
  /// Keeps a pointer to `domain`. Collective.
  PressureLoad(const BodySetup& setup, const Domain& domain, const parallel::Communicator& comm)
      : domain_(&domain), profile_(static_cast<std::size_t>(domain.layout().rows), 1.0) {
    for (std::size_t c = 0; c < setup.layer.bx.size(); ++c)
      largest_ = std::max(largest_, std::hypot(setup.layer.bx[c], setup.layer.by[c]));
    if (setup.thin_spots.none()) return;
    const ColumnLayout& l = domain.layout();
    for (std::int32_t slot = 0; slot < l.column_count; ++slot) {
      const std::size_t c = domain.global_column(slot);
      for (std::int64_t r = 0; r < l.row_count; ++r) {
        share_.push_back(setup.thin_spots.load_share(setup.lattice.section.x[c], setup.lattice.section.y[c],
                                                     setup.lattice.height(l.first_row + r)));
      }
    }
    largest_ *= comm.all_reduce(*std::ranges::max_element(share_), parallel::Reduce::max);
  }

  /// Memory that this takes on all ranks.
  static double bytes(const BodySize& size) { return size.thinned ? size.particles() * sizeof(double) : 0; }

  /// The largest force density for a pressure of 1, on any rank; 1/m.
  double largest() const { return largest_; }

  /// `profile`: [rows of the whole body], the pressure there relative to the one that steps are given.
  void set_profile(std::vector<double> profile) { profile_ = std::move(profile); }

  /// The pressure at a block's rows relative to the one that steps are given.
  const double* profile(RowBlock b) const {
    return profile_.data() + domain_->layout().first_row + b.block * block_rows;
  }

  /// The load of a block's rows relative to the layer's; may be put into `space`.
  const double* shares(RowBlock b, double (&space)[block_rows]) const {
    const double* const profile = this->profile(b);
    if (share_.empty()) return profile;
    const double* const own = share_.data() + domain_->first_particle(b);
    for (int lane = 0; lane < domain_->rows_in(b.block); ++lane) space[lane] = profile[lane] * own[lane];
    return space;
  }

 private:
  const Domain* domain_;
  std::vector<double> profile_;
  std::vector<double> share_;  ///< [owned particles] relative to the whole wall's; empty: 1
  double largest_ = 0;
};

}  // namespace rhexis::peridynamics
