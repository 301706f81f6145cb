// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/engine/memory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "parallel/partition.hpp"
#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/geometry/heterogeneity.hpp"
#include "peridynamics/laws/all_laws.hpp"

namespace rhexis::peridynamics {
namespace {

constexpr double real8 = sizeof(double);

/// Rows that lie within `reach` of a row, itself among them; all in spacings of rows.
double rows_within(double reach) {
  return 2 * std::floor(reach) + 1;
}

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

/// The memory of a body of `ranks` ranks, without its families: see the parts of column_body.hpp for the
/// arrays.
struct BodyMemory {
  double arrays = 0;    ///< bytes
  double observed = 0;  ///< bytes, once its fields have been observed
};

template <class Law>
BodyMemory body_memory(const Parameters& p, const WallSize& size, double rows, bool doubles, int ranks) {
  constexpr auto block_rows = static_cast<double>(parallel::block_rows);
  const double real = doubles ? sizeof(double) : sizeof(float);
  const double particles = size.columns * rows;
  const double blocks = std::ceil(rows / block_rows);
  // Columns in the halos of both sides, where the section is dealt out.
  const double halo =
      ranks > 1
          ? std::min(size.columns, 2 * size.columns * *p.horizon / (2 * std::numbers::pi * p.inner_radius))
          : 0;
  const double stride = block_rows * (blocks + 2);
  const double padded = (size.columns + ranks * halo) * stride;
  double bytes = 0;
  bytes += particles * (6 * real8 + real8);                       // displacement, velocity; family volume
  bytes += padded * 6 * real + size.columns * stride * 4 * real;  // two copies that bonds read; sums
  bytes += size.bonds * (blocks * sizeof(std::uint16_t));         // words of bonds
  bytes += size.bonds * (doubles ? sizeof(BondConstants<double>) : sizeof(BondConstants<float>));
  bytes += size.bonds * (sizeof(std::int32_t) + 2 * sizeof(std::uint16_t));  // other ends, words beyond
  bytes += size.columns * blocks * (real8 + 1);                              // fracture energy
  bytes += size.columns * ranks * 100;                                       // section, layer, slots
  if (!Heterogeneity(p).uniform()) bytes += padded * 2 * real;
  if (p.spots.thin_the_wall()) bytes += padded + particles * real8;
  if constexpr (Law::state_based) bytes += padded * real + particles * real8 + size.columns * blocks * 8;
  return {bytes, particles * 8 * real8};
}

template <class Law>
WallMemory memory_of(const Parameters& p, const WallSize& size, const WallUse& use) {
  const bool doubles = p.bond_precision == Precision::double_precision;
  const double particles = size.particles();
  const double families = size.bonds * sizeof(Bond) + size.columns * (real8 + 40);  // bins, the lattice
  double wall = families * use.ranks;
  // Calibration's conditions, at first, and their dense matrix with its factors.
  const double conditions = 6 * (size.rings + 1);
  const double calibration =
      surface_correction(p) == SurfaceCorrection::calibrated
          ? use.ranks * (3 * conditions * conditions * real8 +
                         size.bonds / std::max(1.0, size.columns) * size.rings * 12 * 40)
          : 0;

  const BodyMemory body = body_memory<Law>(p, size, size.rows, doubles, use.ranks);
  double run = body.arrays + body.observed;
  if (use.outputs) {
    run += particles * 3 * real8;                                           // positions
    run += particles * 3 * (use.doubles ? sizeof(double) : sizeof(float));  // as they are written
    const double across = std::max(1.0, (p.outer_radius - p.inner_radius) / *p.spacing);
    run += particles * 10 / across * use.threads;  // what the opening's gauge knows of rows
  }
  if (use.checkpoints)
    run += particles * 6 * real8 + size.bonds * std::ceil(size.rows / 16) * sizeof(std::uint16_t);
  // A second body, and what relaxes it: displacement, velocity and force.
  if (p.equilibrium_pressure > 0)
    run = std::max(run, 2 * body.arrays + body.observed + particles * 9 * real8);

  const double piece = std::min(size.rows, static_cast<double>(timed_rows * use.ranks));
  const double timed = body_memory<Law>(p, size, piece, doubles, use.ranks).arrays;
  const double periodic_rows = rows_within(*p.horizon * size.rows / p.length) + 1;
  const BodyMemory stability = body_memory<Law>(p, size, periodic_rows, true, 1);
  const double lanczos = size.columns * periodic_rows * real8 * 19;
  // Two unknowns a column; where there is dilatation, those of neighbours' neighbours too.
  const double entry = real8 + sizeof(std::ptrdiff_t);
  double accuracy = size.columns * (4 * size.neighbours * entry + 2 * 10 * real8);
  if constexpr (Law::state_based) accuracy += size.columns * size.neighbours * entry * (2 + 4 * 4 * 2.5);
  const double check = std::max({timed, stability.arrays + stability.observed + lanczos, accuracy});
  return {wall + std::max(calibration, run), wall + std::max(calibration, check)};
}

}  // namespace

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

WallMemory wall_memory(const Parameters& p, const WallSize& size, const WallUse& use) {
  return with_law(p.law, [&]<class Law>(const Law&) { return memory_of<Law>(p, size, use); });
}

}  // namespace rhexis::peridynamics
