// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/bonds/wall_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rhexis::peridynamics {
namespace {

/// Adds up what a column has across the section: for every other column `away` (in spacings), the rows of it
/// that are within the horizon.
struct FamilyCount {
  double horizon, row_step;  ///< in spacings
  double columns = 0, bonds = 0;

  void add(double away, double times) {
    if (away > horizon) return;
    columns += times;
    bonds += times * rows_within(std::sqrt(horizon * horizon - away * away) / row_step * (1 + 1e-9));
  }
};

/// Columns of the section that polar_cross_section makes; bonds ring by ring, for columns of a ring are
/// alike.
void count_polar(const Parameters& p, FamilyCount count, WallSize& size) {
  const double wall = p.outer_radius - p.inner_radius, spacing = *p.spacing;
  const auto rings = std::max(1L, std::lround(wall / spacing));
  const auto around =
      std::max(8L, std::lround(std::numbers::pi * (p.inner_radius + p.outer_radius) / spacing));
  const auto radius = [&](long ring) {
    return (p.inner_radius + wall * (static_cast<double>(ring) + 0.5) / static_cast<double>(rings)) / spacing;
  };
  size.rings = static_cast<double>(rings);
  size.columns = static_cast<double>(rings) * static_cast<double>(around);
  const auto in_reach = static_cast<long>(count.horizon * spacing * static_cast<double>(rings) / wall) + 1;
  for (long ring = 0; ring < rings; ++ring) {
    FamilyCount own = count;
    for (long other = std::max(0L, ring - in_reach); other <= std::min(rings - 1, ring + in_reach); ++other) {
      const double a = radius(ring), b = radius(other);
      for (long step = 0; 2 * step <= around; ++step) {
        const double half_turn = std::numbers::pi * static_cast<double>(step) / static_cast<double>(around);
        const double chord = std::hypot(a - b, 2 * std::sqrt(a * b) * std::sin(half_turn));
        if (chord > own.horizon) break;
        own.add(chord, step == 0 || 2 * step == around ? 1 : 2);
      }
    }
    size.bonds += static_cast<double>(around) * (own.bonds - 1);  // no bond with itself
    size.neighbours += own.columns / static_cast<double>(rings);
  }
}

/// Nodes of a row of the lattice from `first` to `last`.
struct Run {
  double first, last;

  double count() const { return std::max(0.0, last - first + 1); }
};

/// The nodes in the wall of the lattice row at height `y`, left and right of the lumen; lengths in spacings,
/// `shift` is the place of node 0.
std::array<Run, 2> nodes_in_wall(double y, double inner, double outer, double shift) {
  const auto half_chord = [&](double radius) { return std::sqrt(std::max(0.0, radius * radius - y * y)); };
  const double out = half_chord(outer);
  const Run all{std::ceil(-out - shift), std::floor(out - shift)};
  if (std::abs(y) >= inner) return {all, Run{0, -1}};
  const double in = half_chord(inner);
  const double left = std::floor(-in - shift);
  return {Run{all.first, left}, Run{std::max(left + 1, std::ceil(in - shift)), all.last}};
}

void count_lattice(const Parameters& p, FamilyCount whole, WallSize& size) {
  constexpr double tolerance = 1e-9;
  const double inner = p.inner_radius / *p.spacing - tolerance,
               outer = p.outer_radius / *p.spacing + tolerance;
  const double reach = std::floor(whole.horizon);
  constexpr double most_rows = 1e5;
  if (outer > most_rows) {  // whole families: an upper bound for walls that no machine holds
    for (double dy = -reach; dy <= reach; ++dy)
      for (double dx = -reach; dx <= reach; ++dx) whole.add(std::hypot(dx, dy), 1);
    size.columns = std::numbers::pi * (outer * outer - inner * inner);
    size.bonds = size.columns * whole.bonds;
    size.neighbours = whole.columns;
    return;
  }
  const double shift_x = p.lattice_shift[0], shift_y = p.lattice_shift[1];
  const auto row = [&](double j) { return nodes_in_wall(j + shift_y, inner, outer, shift_x); };
  const double first = std::ceil(-outer - shift_y), last = std::floor(outer - shift_y);
  FamilyCount all = whole;  // of all columns together
  for (double j = first; j <= last; ++j) {
    const auto own = row(j);
    size.columns += own[0].count() + own[1].count();
    for (double dy = std::max(-reach, first - j); dy <= std::min(reach, last - j); ++dy) {
      const auto others = row(j + dy);
      for (double dx = -reach; dx <= reach; ++dx) {
        double pairs = 0;
        for (const Run& a : own)
          for (const Run& b : others)
            pairs += Run{std::max(a.first, b.first - dx), std::min(a.last, b.last - dx)}.count();
        all.add(std::hypot(dx, dy), pairs);
      }
    }
  }
  size.bonds = all.bonds - size.columns;  // no bond with itself
  size.neighbours = all.columns / std::max(1.0, size.columns);
}

}  // namespace

double rows_within(double reach) {
  return 2 * std::floor(reach) + 1;
}

WallSize wall_size(const Parameters& p) {
  WallSize size;
  const double rows = std::max(1.0, std::round(p.length / *p.spacing));
  size.rows = rows;
  const FamilyCount count{.horizon = *p.horizon / *p.spacing * (1 + 1e-9),
                          .row_step = p.length / rows / *p.spacing};
  if (p.cross_section == Arrangement::polar)
    count_polar(p, count, size);
  else
    count_lattice(p, count, size);
  return size;
}

}  // namespace rhexis::peridynamics
