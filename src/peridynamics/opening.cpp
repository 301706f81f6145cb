#include "peridynamics/opening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace rhexis::peridynamics {
namespace {

/// Bins to the widest gap of an intact wall: a gap is then known to an eighth.
constexpr double bins_per_gap = 16;

/// A multiple of 64 that gives `widest_gap` (rad) that many.
std::size_t bins_for(double widest_gap) {
  return 64 * static_cast<std::size_t>(std::ceil(bins_per_gap * 2 * std::numbers::pi / widest_gap / 64));
}

/// Widest angle between neighbours among the particles of a row at height `z`, rad.
double widest_gap(const CrossSection& section, const ThinSpots& thin_spots, double z) {
  std::vector<double> angles;
  for (std::size_t c = 0; c < section.size(); ++c) {
    if (thin_spots.none() || thin_spots.present(section.x[c], section.y[c], z))
      angles.push_back(std::atan2(section.y[c], section.x[c]));
  }
  std::sort(angles.begin(), angles.end());
  double widest = angles.front() + 2 * std::numbers::pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
  return widest;
}

/// Of every row.
std::vector<double> widest_gaps(const Lattice& lattice, const ThinSpots& thin_spots) {
  const auto rows = static_cast<std::size_t>(lattice.rows);
  if (thin_spots.none()) return std::vector<double>(rows, widest_gap(lattice.section, thin_spots, 0));
  std::vector<double> gaps(rows);
  for (std::size_t row = 0; row < rows; ++row)
    gaps[row] = widest_gap(lattice.section, thin_spots, lattice.height(static_cast<std::int64_t>(row)));
  return gaps;
}

/// Angle around the axis as a share of a full turn.
double turn(double x, double y) {
  return std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
}

/// Lengths of the runs of clear bits, in bins; the bins close to a circle.
std::vector<std::size_t> empty_runs(std::span<const std::uint64_t> row) {
  const std::size_t bins = 64 * row.size();
  const auto occupied = [&](std::size_t bin) { return (row[bin / 64] >> (bin % 64) & 1) != 0; };
  std::size_t start = 0;
  while (start < bins && !occupied(start)) ++start;
  std::vector<std::size_t> runs;
  if (start == bins) return {bins};
  std::size_t run = 0;
  for (std::size_t i = 1; i <= bins; ++i) {
    if (!occupied((start + i) % bins)) {
      ++run;
    } else if (run > 0) {
      runs.push_back(run);
      run = 0;
    }
  }
  return runs;
}

}  // namespace

OpeningGauge::OpeningGauge(const Lattice& lattice, const Body& body, parallel::Communicator comm,
                           const ThinSpots& thin_spots)
    : body_(&body),
      comm_(comm),
      thin_spots_(thin_spots),
      row_spacing_(lattice.row_spacing),
      radius_quantum_(std::ldexp(lattice.spacing, -20)),
      intact_gap_(widest_gaps(lattice, thin_spots)),
      bins_(bins_for(*std::ranges::min_element(intact_gap_))),
      // Two widest gaps wide, so that none is empty.
      sectors_(std::max<std::size_t>(
          1, static_cast<std::size_t>(std::numbers::pi / *std::ranges::max_element(intact_gap_)))) {
  for (std::size_t c = 0; c < lattice.section.size(); ++c)
    sector_of_.push_back(
        std::min(sectors_ - 1, static_cast<std::size_t>(turn(lattice.section.x[c], lattice.section.y[c]) *
                                                        static_cast<double>(sectors_))));
}

double OpeningGauge::area() const {
  const PointLayout& layout = body_->layout();
  const auto u = body_->displacement();
  const std::size_t words = bins_ / 64;
  const double bin_width = 2 * std::numbers::pi / static_cast<double>(bins_);
  std::vector<std::uint64_t> occupied(static_cast<std::size_t>(layout.rows) * words);
  std::vector<std::int64_t> radii(static_cast<std::size_t>(layout.rows));  // sums, in quanta
  std::vector<std::int64_t> particles(radii.size());
  std::vector<double> lowest(radii.size() * sectors_, std::numeric_limits<double>::max());
  std::vector<double> highest(lowest.size(), std::numeric_limits<double>::lowest());
  std::size_t i = 0;
  for (std::int64_t c = 0; c < layout.column_count; ++c) {
    for (std::int64_t r = 0; r < layout.row_count; ++r, ++i) {
      const auto x = body_->reference_position(c, r);
      if (!thin_spots_.none() && !thin_spots_.present(x[0], x[1], x[2])) continue;
      const double px = x[0] + u[0][i], py = x[1] + u[1][i];
      const auto row = static_cast<std::size_t>(layout.first_row + r);
      const auto bin =
          std::min(bins_ - 1, static_cast<std::size_t>(turn(px, py) * static_cast<double>(bins_)));
      occupied[row * words + bin / 64] |= std::uint64_t{1} << (bin % 64);
      ++particles[row];
      radii[row] += std::llround(std::min(std::hypot(px, py) / radius_quantum_, 0x1p40));
      const std::size_t place =
          row * sectors_ + sector_of_[static_cast<std::size_t>(layout.first_column + c)];
      lowest[place] = std::min(lowest[place], x[2] + u[2][i]);
      highest[place] = std::max(highest[place], x[2] + u[2][i]);
    }
  }
  comm_.all_reduce(occupied, parallel::Reduce::bit_or);
  comm_.all_reduce(radii, parallel::Reduce::sum);
  comm_.all_reduce(particles, parallel::Reduce::sum);
  comm_.all_reduce(lowest, parallel::Reduce::min);
  comm_.all_reduce(highest, parallel::Reduce::max);

  const double sector_width = 2 * std::numbers::pi / static_cast<double>(sectors_);
  double area = 0;
  for (std::size_t row = 0; row < radii.size(); ++row) {
    const double radius =
        static_cast<double>(radii[row]) * radius_quantum_ / static_cast<double>(particles[row]);
    const double intact = intact_gap_[row];
    for (std::size_t run : empty_runs({&occupied[row * words], words})) {
      // A run of n empty bins lies between particles that are n to n + 2 bins apart.
      const double gap = static_cast<double>(run + 1) * bin_width;
      if (gap > 1.5 * intact) area += (gap - intact) * radius * row_spacing_;
    }
    for (std::size_t sector = 0; sector < sectors_ && row > 0; ++sector) {
      const double gap = lowest[row * sectors_ + sector] - highest[(row - 1) * sectors_ + sector];
      if (gap > 1.5 * row_spacing_) area += (gap - row_spacing_) * radius * sector_width;
    }
  }
  return area;
}

LumenGauge::LumenGauge(const Lattice& lattice, const Body& body, parallel::Communicator comm)
    : body_(&body), comm_(comm) {
  const CrossSection& s = lattice.section;
  double least = INFINITY;
  for (std::size_t c = 0; c < s.size(); ++c) least = std::min(least, std::hypot(s.x[c], s.y[c]));
  for (std::size_t c = 0; c < s.size(); ++c) {
    if (std::hypot(s.x[c], s.y[c]) < least + 0.75 * lattice.spacing) {
      innermost_.push_back(static_cast<std::int64_t>(c));
    }
  }
}

double LumenGauge::resistance_factor() const {
  constexpr double quantum = 0x1p-40;  // of stretch: sums of integers do not depend on ranks
  const PointLayout& layout = body_->layout();
  const auto u = body_->displacement();
  std::vector<std::int64_t> stretch(static_cast<std::size_t>(layout.rows));
  for (const std::int64_t column : innermost_) {
    const std::int64_t c = column - layout.first_column;
    if (c < 0 || c >= layout.column_count) continue;
    for (std::int64_t r = 0; r < layout.row_count; ++r) {
      const auto i = static_cast<std::size_t>(c * layout.row_count + r);
      const auto x = body_->reference_position(c, r);
      const double now = std::hypot(x[0] + u[0][i], x[1] + u[1][i]);
      stretch[static_cast<std::size_t>(layout.first_row + r)] +=
          std::llround(std::min(now / std::hypot(x[0], x[1]), 1e4) / quantum);
    }
  }
  comm_.all_reduce(stretch, parallel::Reduce::sum);
  double sum = 0;
  for (const std::int64_t s : stretch) {
    const double mean = static_cast<double>(s) * quantum / static_cast<double>(innermost_.size());
    sum += std::pow(mean, -4);
  }
  return sum / static_cast<double>(layout.rows);
}

double venting_factor(double open_area, double supply_area) {
  const double ratio = open_area / supply_area;
  return 1 / (1 + ratio * ratio);
}

double orifice_flow(double discharge_coefficient, double area, double pressure, double density) {
  return discharge_coefficient * area * std::sqrt(2 * std::max(pressure, 0.0) / density);
}

}  // namespace rhexis::peridynamics
