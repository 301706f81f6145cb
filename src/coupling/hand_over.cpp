#include "coupling/hand_over.hpp"

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

Piece choose_piece(const VesselData& v, std::int64_t particles, bool always_paper) {
  const double outer = v.radius + v.wall_thickness;
  const double wall_area = std::numbers::pi * (outer * outer - v.radius * v.radius);
  Piece piece;
  piece.paper_spacing =
      peridynamics::constant_number_spacing(v.radius, outer, v.length, static_cast<double>(particles));
  piece.spacing = piece.paper_spacing;
  piece.length = v.length;
  if (!always_paper && v.wall_thickness < least_across * piece.paper_spacing) {
    piece.spacing = v.wall_thickness / enough_across;
    piece.length = static_cast<double>(particles) * std::pow(piece.spacing, 3) / wall_area;
    piece.whole = false;
    piece.start = (v.length - piece.length) / 2;
  }
  if (piece.length < least_rows * piece.spacing) {
    const bool short_vessel = piece.whole;
    throw InputError(
        short_vessel
            ? "the vessel (" + quantity(v.length, "m") + ") is shorter than 10 spacings of " +
                  quantity(piece.spacing, "m") + ", which " + std::to_string(particles) +
                  " particles leave; take more particles, or a longer vessel"
            : std::to_string(particles) + " particles at 5 spacings across the wall (" +
                  quantity(v.wall_thickness, "m") + ") fill fewer than 10 rows of this vessel; take " +
                  std::to_string(
                      std::lround(std::ceil(least_rows * wall_area / (piece.spacing * piece.spacing)))) +
                  " or more",
        "discretisation.particles");
  }
  return piece;
}

Piece hand_over(const VesselData& v, bool always_paper, peridynamics::Parameters& p) {
  Piece piece;
  if (p.spacing) {
    piece.length = v.length;
    piece.spacing = piece.paper_spacing = *p.spacing;
  } else {
    piece = choose_piece(v, p.particles.value_or(usual_particles), always_paper);
    p.spacing = piece.spacing;
    p.particles.reset();
  }
  p.inner_radius = v.radius;
  p.outer_radius = v.radius + v.wall_thickness;
  p.length = piece.length;
  return piece;
}

double clamped_reach(double mid_radius, double wall_thickness, double poisson_ratio) {
  return std::numbers::pi * std::sqrt(mid_radius * wall_thickness) /
         std::pow(3 * (1 - poisson_ratio * poisson_ratio), 0.25);
}

double largest_load(const AxialLoad& load, const VesselData& v, const Piece& piece) {
  const double first = std::clamp(piece.start / v.length, 0.0, 1.0),
               last = std::clamp((piece.start + piece.length) / v.length, 0.0, 1.0);
  const double ends = std::max(load.at(first), load.at(last));
  return first < 0.5 && last > 0.5 ? std::max(ends, load.pressure[1]) : ends;
}

std::vector<double> axial_profile(const AxialLoad& load, const VesselData& v, const Piece& piece,
                                  std::int64_t rows, double row_spacing) {
  std::vector<double> profile(static_cast<std::size_t>(rows), 1.0);
  const double largest = largest_load(load, v, piece);
  if (!(largest > 0)) return profile;
  for (std::size_t row = 0; row < profile.size(); ++row) {
    const double z = piece.start + (static_cast<double>(row) + 0.5) * row_spacing;
    profile[row] = load.at(std::clamp(z / v.length, 0.0, 1.0)) / largest;
  }
  return profile;
}

}  // namespace rhexis::coupling
