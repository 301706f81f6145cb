// SPDX-License-Identifier: BSD-3-Clause
/// Cross-sections of the wall: one point per column of particles.
///
/// A straight vessel is a cross-section extruded along z. Column c stands at (x[c], y[c]) and owns area[c];
/// its particles lie at z = (row + 1/2) * row_spacing and have volume area[c] * row_spacing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

struct CrossSection {
  std::vector<double> x, y;              ///< m, from the vessel's axis
  std::vector<double> area;              ///< m2
  std::int32_t rings = 0, per_ring = 0;  ///< rings, and columns in each, of a polar cross-section; else 0

  std::size_t size() const { return x.size(); }
};

/// Cubic lattice of step `spacing` clipped to r0 <= r <= r1 (Sec. 3.2); `shift_x`, `shift_y` in spacings.
CrossSection lattice_cross_section(double inner_radius, double outer_radius, double spacing, double shift_x,
                                   double shift_y);

/// Rings that follow the wall: round((r1 - r0) / spacing) rings of equally many columns, aligned, about
/// `spacing` apart at mid-wall; the areas fill the wall exactly.
CrossSection polar_cross_section(double inner_radius, double outer_radius, double spacing);

/// Turns all columns about the axis by `angle`, rad.
void rotate(CrossSection& section, double angle);

/// A vessel's particles before any are made: where columns stand, how many rows, how far apart.
struct Lattice {
  CrossSection section;
  std::int64_t rows = 0;
  double row_spacing = 0;  ///< m
  double spacing = 0;      ///< m, nominal; the unit of length inside the kernels
  double horizon = 0;      ///< m

  std::int64_t particles() const { return static_cast<std::int64_t>(section.size()) * rows; }
  double volume(std::size_t column) const { return section.area[column] * row_spacing; }
  double height(std::int64_t row) const { return (static_cast<double>(row) + 0.5) * row_spacing; }  ///< z, m
};

/// The lattice that resolved parameters ask for. Throws InputError where no particle falls into the wall.
Lattice make_lattice(const Parameters& p);

}  // namespace rhexis::peridynamics
