// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/monitors/opening.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>

#include "parallel/threads.hpp"

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

/// The widest gap of each row, rad.
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
  std::vector<std::size_t> occupied;
  for (std::size_t word = 0; word < row.size(); ++word) {
    for (std::uint64_t bits = row[word]; bits != 0; bits &= bits - 1)
      occupied.push_back(64 * word + static_cast<std::size_t>(std::countr_zero(bits)));
  }
  if (occupied.empty()) return {bins};
  occupied.push_back(occupied.front() + bins);
  std::vector<std::size_t> runs;
  for (std::size_t i = 1; i < occupied.size(); ++i) {
    if (const std::size_t run = occupied[i] - occupied[i - 1] - 1; run > 0) runs.push_back(run);
  }
  return runs;
}

}  // namespace

OpeningGauge::OpeningGauge(const Lattice& lattice, const Body& body, parallel::Communicator comm,
                           EndCondition ends, const ThinSpots& thin_spots,
                           std::span<const std::int64_t> lattice_number)
    : lattice_(&lattice),
      body_(&body),
      places_(body, lattice, lattice_number),
      comm_(comm),
      periodic_(ends == EndCondition::axial_periodic),
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

/// What some of a row's particles tell, for each row of the whole body.
struct OpeningGauge::Rows {
  Rows(const OpeningGauge& gauge, std::size_t rows)
      : occupied(rows * gauge.bins_ / 64),
        radii(rows),
        particles(rows),
        lowest(rows * gauge.sectors_, std::numeric_limits<double>::max()),
        highest(lowest.size(), std::numeric_limits<double>::lowest()) {}

  std::vector<std::uint64_t> occupied;  ///< [rows][bins], a bit each
  std::vector<std::int64_t> radii;      ///< sums, in quanta
  std::vector<std::int64_t> particles;  ///< how many
  std::vector<double> lowest, highest;  ///< m, [rows][sectors]
};

void OpeningGauge::look_at(std::size_t begin, std::size_t end, Rows& rows) const {
  const auto u = body_->displacement();
  const std::size_t words = bins_ / 64;
  for (std::size_t i = begin; i < end; ++i) {
    const auto [column, row] = places_.of(i);
    const double x = lattice_->section.x[column], y = lattice_->section.y[column],
                 z = lattice_->height(static_cast<std::int64_t>(row));
    if (!thin_spots_.none() && !thin_spots_.present(x, y, z)) continue;
    const double px = x + u[0][i], py = y + u[1][i], pz = z + u[2][i];
    const auto bin = std::min(bins_ - 1, static_cast<std::size_t>(turn(px, py) * static_cast<double>(bins_)));
    rows.occupied[row * words + bin / 64] |= std::uint64_t{1} << (bin % 64);
    ++rows.particles[row];
    rows.radii[row] += std::llround(std::min(std::sqrt(px * px + py * py) / radius_quantum_, 0x1p40));
    const std::size_t place = row * sectors_ + sector_of_[column];
    rows.lowest[place] = std::min(rows.lowest[place], pz);
    rows.highest[place] = std::max(rows.highest[place], pz);
  }
}

double OpeningGauge::area() const {
  const std::size_t words = bins_ / 64;
  const double bin_width = 2 * std::numbers::pi / static_cast<double>(bins_);
  const int threads = parallel::thread_count();
  std::vector<Rows> seen(static_cast<std::size_t>(threads),
                         Rows(*this, static_cast<std::size_t>(lattice_->rows)));
  parallel::for_each_share(threads, body_->displacement()[0].size(),
                           [&](int thread, std::size_t begin, std::size_t end) {
                             look_at(begin, end, seen[static_cast<std::size_t>(thread)]);
                           });
  auto& [occupied, radii, particles, lowest, highest] = seen.front();
  const auto merge = [](auto& into, const auto& from, const auto& how) {
    std::transform(into.begin(), into.end(), from.begin(), into.begin(), how);
  };
  for (std::size_t t = 1; t < seen.size(); ++t) {
    merge(occupied, seen[t].occupied, std::bit_or<>());
    merge(radii, seen[t].radii, std::plus<>());
    merge(particles, seen[t].particles, std::plus<>());
    merge(lowest, seen[t].lowest, [](double a, double b) { return std::min(a, b); });
    merge(highest, seen[t].highest, [](double a, double b) { return std::max(a, b); });
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
    if (row == 0 && !periodic_) continue;
    const std::size_t before = (row == 0 ? radii.size() : row) - 1;
    const double period = row == 0 ? static_cast<double>(radii.size()) * row_spacing_ : 0;
    for (std::size_t sector = 0; sector < sectors_; ++sector) {
      const double gap = lowest[row * sectors_ + sector] + period - highest[before * sectors_ + sector];
      if (gap > 1.5 * row_spacing_) area += (gap - row_spacing_) * radius * sector_width;
    }
  }
  return area;
}

LumenGauge::LumenGauge(const Lattice& lattice, const Body& body, parallel::Communicator comm,
                       std::span<const std::int64_t> lattice_number)
    : lattice_(&lattice), body_(&body), places_(body, lattice, lattice_number), comm_(comm) {
  const CrossSection& s = lattice.section;
  double least = INFINITY;
  for (std::size_t c = 0; c < s.size(); ++c) least = std::min(least, std::hypot(s.x[c], s.y[c]));
  for (std::size_t c = 0; c < s.size(); ++c)
    innermost_.push_back(std::hypot(s.x[c], s.y[c]) < least + 0.75 * lattice.spacing);
  innermost_count_ = std::ranges::count(innermost_, true);
}

std::vector<double> LumenGauge::stretch_of_rows() const {
  constexpr double quantum = 0x1p-40;  // of stretch: sums of integers do not depend on ranks
  const auto u = body_->displacement();
  std::vector<std::int64_t> stretch(static_cast<std::size_t>(lattice_->rows));
  for (std::size_t i = 0; i < u[0].size(); ++i) {
    const auto [column, row] = places_.of(i);
    if (!innermost_[column]) continue;
    const double x = lattice_->section.x[column], y = lattice_->section.y[column];
    const double now = std::hypot(x + u[0][i], y + u[1][i]);
    stretch[row] += std::llround(std::min(now / std::hypot(x, y), 1e4) / quantum);
  }
  comm_.all_reduce(stretch, parallel::Reduce::sum);
  std::vector<double> mean;
  for (const std::int64_t s : stretch)
    mean.push_back(static_cast<double>(s) * quantum / static_cast<double>(innermost_count_));
  return mean;
}

double LumenGauge::resistance_factor() const {
  const std::vector<double> stretch = stretch_of_rows();
  double sum = 0;
  for (const double s : stretch) sum += std::pow(s, -4);
  return sum / static_cast<double>(stretch.size());
}

double LumenGauge::largest_stretch() const {
  const std::vector<double> stretch = stretch_of_rows();
  return *std::max_element(stretch.begin(), stretch.end());
}

}  // namespace rhexis::peridynamics
