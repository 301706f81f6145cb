// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/loads/thin_spots.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace rhexis::peridynamics {
namespace {

constexpr double rounding =
    1 + 1e-9;  ///< a particle exactly at the edge is inside, whatever the last digit says

}  // namespace

ThinSpots::ThinSpots(const Parameters& p, const Lattice& lattice, const PressureLayer& layer)
    : inner_radius_(p.inner_radius),
      outer_radius_(p.outer_radius),
      spots_(p.spots),
      keeps_resultant_(p.layer != LayerForce::paper) {
  if (!spots_.thin_the_wall()) return;
  const CrossSection& s = lattice.section;
  const auto load = [&](std::size_t c) { return std::hypot(layer.bx[c], layer.by[c]) * lattice.volume(c); };
  for (std::size_t c = 0; c < s.size(); ++c) {
    if (load(c) > 0) borne_within_.emplace_back(std::hypot(s.x[c], s.y[c]), load(c));
  }
  std::ranges::sort(borne_within_);
  for (std::size_t i = 1; i < borne_within_.size(); ++i)
    borne_within_[i].second += borne_within_[i - 1].second;
  const double total = borne_within_.back().second;
  for (auto& [radius, share] : borne_within_) share /= total;

  double wanted = 0,
         borne = 0;  // of the places that lack a part of the layer: in the whole wall, and in this
  for (std::size_t c = 0; c < s.size(); ++c) {
    for (std::int64_t row = 0; row < lattice.rows; ++row) {
      const double z = lattice.height(row);
      const bool here = present(s.x[c], s.y[c], z);
      if (!here) ++absent_;
      const double left = share_left(s.x[c], s.y[c], z);
      if (left == 1) continue;
      wanted += load(c);
      if (here) borne += load(c) / left;
    }
  }
  if (!keeps_resultant_ || wanted == 0) return;
  if (borne == 0) throw InputError("leaves no particle to bear the pressure", "spot[1].thickness");
  balance_ = wanted / borne;
}

double ThinSpots::outer_radius_at(double x, double y, double z) const {
  const double mid_radius = 0.5 * (inner_radius_ + outer_radius_), angle = std::atan2(y, x);
  double share = 1;
  for (const Spot& spot : spots_.list)
    share = std::min(share, 1 + (spot.thickness - 1) * spots_.nearness(spot, mid_radius, angle, z));
  return inner_radius_ + share * (outer_radius_ - inner_radius_);
}

bool ThinSpots::present(double x, double y, double z) const {
  return std::hypot(x, y) <= outer_radius_at(x, y, z) * rounding;
}

double ThinSpots::share_left(double x, double y, double z) const {
  const auto past = std::ranges::upper_bound(borne_within_, outer_radius_at(x, y, z) * rounding, {},
                                             &std::pair<double, double>::first);
  return past == borne_within_.begin() ? 0 : (past - 1)->second;
}

double ThinSpots::load_share(double x, double y, double z) const {
  if (!present(x, y, z)) return 0;
  const double left = share_left(x, y, z);
  return keeps_resultant_ && left < 1 ? balance_ / left : 1;
}

}  // namespace rhexis::peridynamics
