#include "peridynamics/thin_spots.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace rhexis::peridynamics {

ThinSpots::ThinSpots(const Parameters& p, const Lattice& lattice, const PressureLayer& layer)
    : inner_radius_(p.inner_radius),
      outer_radius_(p.outer_radius),
      layer_radius_(std::min(p.outer_radius, p.inner_radius + *p.layer_thickness)),
      spots_(p.spots),
      keeps_resultant_(p.layer == "consistent") {
  if (std::ranges::all_of(spots_.thickness, [](double f) { return f == 1; })) return;
  double wanted = 0,
         borne = 0;  // m2, of the thin part of the layer: resultant in the whole wall, and in this
  for (std::size_t c = 0; c < lattice.section.size(); ++c) {
    const double x = lattice.section.x[c], y = lattice.section.y[c];
    const double load = std::hypot(layer.bx[c], layer.by[c]) * lattice.volume(c);
    for (std::int64_t row = 0; row < lattice.rows; ++row) {
      const double z = lattice.height(row);
      const bool here = present(x, y, z);
      if (!here) ++absent_;
      if (load == 0 || !in_thin_layer(x, y, z)) continue;
      wanted += load;
      if (here) borne += load * crowding(x, y, z);
    }
  }
  if (!keeps_resultant_ || wanted == 0) return;
  if (borne == 0) throw InputError("leaves no particle to bear the pressure", "spot[1].thickness");
  balance_ = wanted / borne;
}

double ThinSpots::outer_radius_at(double x, double y, double z) const {
  const double mid_radius = 0.5 * (inner_radius_ + outer_radius_), angle = std::atan2(y, x);
  double share = 1;
  for (std::size_t i = 0; i < spots_.size(); ++i)
    share = std::min(share, 1 + (spots_.thickness[i] - 1) * spots_.nearness(i, mid_radius, angle, z));
  return inner_radius_ + share * (outer_radius_ - inner_radius_);
}

bool ThinSpots::present(double x, double y, double z) const {
  return std::hypot(x, y) <= outer_radius_at(x, y, z) * (1 + 1e-9);
}

bool ThinSpots::in_thin_layer(double x, double y, double z) const {
  return outer_radius_at(x, y, z) < layer_radius_;
}

double ThinSpots::crowding(double x, double y, double z) const {
  const auto area = [&](double radius) { return radius * radius - inner_radius_ * inner_radius_; };
  return area(layer_radius_) / area(outer_radius_at(x, y, z));
}

double ThinSpots::load_share(double x, double y, double z) const {
  if (!present(x, y, z)) return 0;
  return keeps_resultant_ && in_thin_layer(x, y, z) ? balance_ * crowding(x, y, z) : 1;
}

}  // namespace rhexis::peridynamics
