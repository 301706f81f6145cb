// SPDX-License-Identifier: BSD-3-Clause
/// From a vessel of the network to a peridynamic wall (Sec. 3.3).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "peridynamics/parameters.hpp"

namespace rhexis::coupling {

/// What the network knows of a vessel.
struct VesselData {
  double radius = 0, wall_thickness = 0, length = 0;  ///< m
};

/// Net pressures along a vessel, Pa: at its beginning, half way and at its end, linear in between.
struct AxialLoad {
  std::array<double, 3> pressure{};

  /// At a share of the vessel's length, 0 to 1.
  double at(double share) const;
};

/// The segment of a vessel that is simulated.
struct WallSegment {
  double start = 0, length = 0;  ///< m, along the vessel
  double spacing = 0;            ///< m
  bool whole = true;
  double paper_spacing = 0;  ///< m, of the constant-N rule
};

/// Particles of a wall where the input does not say.
inline constexpr std::int64_t usual_particles = 55000;
/// Spacings across the wall below which the constant-N rule gives way, and what it gives way to.
inline constexpr double least_across = 4, enough_across = 5;
/// Rows of particles that a segment must have.
inline constexpr double least_rows = 10;

/// The spacing (pi (r1^2 - r0^2) L / N)^(1/3) for the whole vessel (Sec. 3.3), or, where that is too coarse
/// and `always_paper` is not set, the segment in the middle that N particles fill. Throws InputError
/// (discretisation.particles) where fewer than `least_rows` rows are left.
WallSegment choose_wall_segment(const VesselData& vessel, std::int64_t particles, bool always_paper);

/// Geometry and discretisation of the segment, into `p`, which is not resolved yet. A spacing that `p` has is
/// kept, for the whole vessel.
WallSegment extract_wall_segment(const VesselData& vessel, bool always_paper, peridynamics::Parameters& p);

/// How far a clamped end holds a thin wall back, m: from pi / beta on, beta^4 = 3 (1 - nu^2) / (R h)^2 with R
/// the radius at mid-wall and h its thickness, the displacement is within 5 % of an endless wall's
/// (Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, Sec. 114).
double clamped_reach(double mid_radius, double wall_thickness, double poisson_ratio);

/// The largest load on the segment, Pa.
double largest_load(const AxialLoad& load, const VesselData& vessel, const WallSegment& segment);

/// The load at a height z (m) of the segment, relative to `largest_load`: 1 where the load is uniform, to the
/// last bit.
std::function<double(double z)> axial_profile(const AxialLoad& load, const VesselData& vessel,
                                              const WallSegment& segment);

}  // namespace rhexis::coupling
