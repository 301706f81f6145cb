// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/geometry/cross_section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.hpp"

namespace rhexis::peridynamics {
namespace {

/// Columns ordered by angle, then radius: neighbours lie close in memory and a range of columns is an arc.
CrossSection sorted_by_angle(const CrossSection& s) {
  std::vector<std::size_t> order(s.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> angle(s.size()), radius(s.size());
  for (std::size_t c = 0; c < s.size(); ++c) {
    angle[c] = std::atan2(s.y[c], s.x[c]);
    radius[c] = std::hypot(s.x[c], s.y[c]);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return angle[a] != angle[b] ? angle[a] < angle[b] : radius[a] < radius[b];
  });
  CrossSection result;
  for (std::size_t c : order) {
    result.x.push_back(s.x[c]);
    result.y.push_back(s.y[c]);
    result.area.push_back(s.area[c]);
  }
  return result;
}

}  // namespace

CrossSection lattice_cross_section(double inner_radius, double outer_radius, double spacing, double shift_x,
                                   double shift_y) {
  // Nodes whose distance is r0 or r1 up to round-off belong to the wall.
  constexpr double tolerance = 1e-9;
  const double inner = inner_radius / spacing - tolerance;
  const double outer = outer_radius / spacing + tolerance;
  const auto reach = static_cast<long>(std::ceil(outer)) + 1;
  CrossSection section;
  for (long j = -reach; j <= reach; ++j) {
    for (long i = -reach; i <= reach; ++i) {
      const double x = static_cast<double>(i) + shift_x;
      const double y = static_cast<double>(j) + shift_y;
      const double r = std::hypot(x, y);
      if (r < inner || r > outer) continue;
      section.x.push_back(x * spacing);
      section.y.push_back(y * spacing);
      section.area.push_back(spacing * spacing);
    }
  }
  return sorted_by_angle(section);
}

void rotate(CrossSection& section, double angle) {
  if (angle == 0) return;
  const double c = std::cos(angle), s = std::sin(angle);
  for (std::size_t i = 0; i < section.size(); ++i) {
    const double x = section.x[i], y = section.y[i];
    section.x[i] = c * x - s * y;
    section.y[i] = s * x + c * y;
  }
}

CrossSection polar_cross_section(double inner_radius, double outer_radius, double spacing) {
  const double wall = outer_radius - inner_radius;
  const long rings = std::max(1L, std::lround(wall / spacing));
  const double mid_circumference = std::numbers::pi * (inner_radius + outer_radius);
  const long per_ring = std::max(8L, std::lround(mid_circumference / spacing));
  CrossSection section;
  for (long t = 0; t < per_ring; ++t) {
    // Half a step off the axes, so that opposite columns are exact mirror images.
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(t) + 0.5) / static_cast<double>(per_ring);
    for (long k = 0; k < rings; ++k) {
      const double r_in = inner_radius + wall * static_cast<double>(k) / static_cast<double>(rings);
      const double r_out = inner_radius + wall * static_cast<double>(k + 1) / static_cast<double>(rings);
      const double r = 0.5 * (r_in + r_out);
      section.x.push_back(r * std::cos(angle));
      section.y.push_back(r * std::sin(angle));
      section.area.push_back(std::numbers::pi * (r_out * r_out - r_in * r_in) /
                             static_cast<double>(per_ring));
    }
  }
  section = sorted_by_angle(section);
  section.rings = static_cast<std::int32_t>(rings);
  section.per_ring = static_cast<std::int32_t>(per_ring);
  return section;
}

Lattice make_lattice(const Parameters& p) {
  Lattice lattice;
  lattice.spacing = *p.spacing;
  lattice.horizon = *p.horizon;
  lattice.section = p.cross_section == Arrangement::polar
                        ? polar_cross_section(p.inner_radius, p.outer_radius, *p.spacing)
                        : lattice_cross_section(p.inner_radius, p.outer_radius, *p.spacing,
                                                p.lattice_shift[0], p.lattice_shift[1]);
  rotate(lattice.section, p.rotation);
  if (lattice.section.size() == 0) {
    throw InputError("no particle falls into the wall at this spacing", "discretisation.spacing");
  }
  lattice.rows = std::max<std::int64_t>(1, std::llround(p.length / *p.spacing));
  lattice.row_spacing = p.length / static_cast<double>(lattice.rows);
  return lattice;
}

}  // namespace rhexis::peridynamics
