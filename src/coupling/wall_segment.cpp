// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/wall_segment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::coupling {

double AxialLoad::at(double share) const {
  const std::size_t half = share < 0.5 ? 0 : 1;
  return std::lerp(pressure[half], pressure[half + 1], 2 * share - static_cast<double>(half));
}

WallSegment choose_wall_segment(const VesselData& v, std::int64_t particles, bool always_paper) {
  const double outer = v.radius + v.wall_thickness;
  const double wall_area = std::numbers::pi * (outer * outer - v.radius * v.radius);
  WallSegment segment;
  segment.paper_spacing =
      peridynamics::constant_number_spacing(v.radius, outer, v.length, static_cast<double>(particles));
  segment.spacing = segment.paper_spacing;
  segment.length = v.length;
  if (!always_paper && v.wall_thickness < least_across * segment.paper_spacing) {
    segment.spacing = v.wall_thickness / enough_across;
    segment.length = static_cast<double>(particles) * std::pow(segment.spacing, 3) / wall_area;
    segment.whole = false;
    segment.start = (v.length - segment.length) / 2;
  }
  if (segment.length < least_rows * segment.spacing) {
    const bool short_vessel = segment.whole;
    throw InputError(
        short_vessel
            ? "the vessel (" + quantity(v.length, "m") + ") is shorter than 10 spacings of " +
                  quantity(segment.spacing, "m") + ", which " + std::to_string(particles) +
                  " particles leave; take more particles, or a longer vessel"
            : std::to_string(particles) + " particles at 5 spacings across the wall (" +
                  quantity(v.wall_thickness, "m") + ") fill fewer than 10 rows of this vessel; take " +
                  std::to_string(
                      std::lround(std::ceil(least_rows * wall_area / (segment.spacing * segment.spacing)))) +
                  " or more",
        "discretisation.particles");
  }
  return segment;
}

WallSegment extract_wall_segment(const VesselData& v, bool always_paper, peridynamics::Parameters& p) {
  WallSegment segment;
  if (p.spacing) {
    segment.length = v.length;
    segment.spacing = segment.paper_spacing = *p.spacing;
  } else {
    segment = choose_wall_segment(v, p.particles.value_or(usual_particles), always_paper);
    p.spacing = segment.spacing;
    p.particles.reset();
  }
  p.inner_radius = v.radius;
  p.outer_radius = v.radius + v.wall_thickness;
  p.length = segment.length;
  return segment;
}

double clamped_reach(double mid_radius, double wall_thickness, double poisson_ratio) {
  return std::numbers::pi * std::sqrt(mid_radius * wall_thickness) /
         std::pow(3 * (1 - poisson_ratio * poisson_ratio), 0.25);
}

double largest_load(const AxialLoad& load, const VesselData& v, const WallSegment& segment) {
  const double first = std::clamp(segment.start / v.length, 0.0, 1.0),
               last = std::clamp((segment.start + segment.length) / v.length, 0.0, 1.0);
  const double ends = std::max(load.at(first), load.at(last));
  return first < 0.5 && last > 0.5 ? std::max(ends, load.pressure[1]) : ends;
}

std::function<double(double)> axial_profile(const AxialLoad& load, const VesselData& v,
                                            const WallSegment& segment) {
  const double largest = largest_load(load, v, segment);
  if (!(largest > 0)) return [](double) { return 1.0; };
  return [load, largest, start = segment.start, length = v.length](double z) {
    return load.at(std::clamp((start + z) / length, 0.0, 1.0)) / largest;
  };
}

}  // namespace rhexis::coupling
