// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/format.hpp"
#include "network/lines/line_merging.hpp"

namespace rhexis::network::vtp {
namespace {

/// Lines that draw apart by more than this for each length along them have parted.
constexpr double steepest = 0.1;

class Repetitions {
 public:
  explicit Repetitions(LineDrawing& drawing)
      : drawing_(drawing), drawn_(drawing.end_of(drawing.lines() - 1)) {}

  std::vector<std::string> leave_out(double metres_per_unit) {
    for (std::size_t line = 0; line < drawing_.lines(); ++line) {
      find_candidates(line);
      const std::size_t segments = near_.size();
      for (std::size_t s = 0; s < segments; ++s) {
        if (!near_[s]) continue;
        std::size_t end = s;
        while (end < segments && near_[end]) ++end;
        leave_out_run(line, s, end);
        s = end;
      }
      for (std::size_t s = drawing_.begin_of(line); s + 1 < drawing_.end_of(line); ++s) draw(s);
    }
    return notes(metres_per_unit);
  }

 private:
  using Location = LineDrawing::Location;
  /// How far the ends of a segment are from the lines that it repeats, and how far its farthest point; how
  /// much radii differ in its middle, relative to the larger.
  struct Distances {
    double first, last, largest, radii;
  };

  /// The nearest place that is drawn already, within the tolerance of a point of a line.
  std::optional<Location> drawn_near(std::size_t line, const Point& x, double radius) const {
    const bool may_be_parallel = drawing_.has_two_points(line);
    return drawing_.nearest(
        drawn_, x,
        [&](std::size_t segment) {
          return !may_be_parallel || !drawing_.has_two_points(drawing_.line_of(segment));
        },
        [&](double there) { return drawing_.tolerance() * std::min(radius, there); });
  }

  /// Distances of the segment from what is drawn already; none where any of its samples, no farther apart
  /// than a radius, is farther from it than the tolerance. Its middle comes first: it tells most.
  std::optional<Distances> measure(std::size_t line, std::size_t segment) {
    const Point a = drawing_.position(drawing_.point(segment));
    const Point b = drawing_.position(drawing_.point(segment + 1));
    const double radius_a = drawing_.radius(segment), radius_b = drawing_.radius(segment + 1);
    const auto at = [&](double t) {
      return drawn_near(line, {std::lerp(a[0], b[0], t), std::lerp(a[1], b[1], t), std::lerp(a[2], b[2], t)},
                        std::lerp(radius_a, radius_b, t));
    };
    const auto middle = at(0.5);
    if (!middle) return std::nullopt;
    const auto first = at(0), last = at(1);
    if (!first || !last) return std::nullopt;
    Distances d{first->distance, last->distance,
                std::max({first->distance, middle->distance, last->distance}),
                std::abs(radius_a + radius_b - 2 * middle->radius) /
                    std::max(radius_a + radius_b, 2 * middle->radius)};
    const double length_in_radii = drawing_.length(segment) / std::max(radius_a, radius_b);
    const int samples = static_cast<int>(std::clamp(std::ceil(length_in_radii), 2.0, 64.0));
    for (int i = 1; i < samples; ++i) {
      const auto between = at(static_cast<double>(i) / samples);
      if (!between) return std::nullopt;
      d.largest = std::max(d.largest, between->distance);
    }
    return d;
  }

  void find_candidates(std::size_t line) {
    const std::size_t begin = drawing_.begin_of(line);
    near_.assign(drawing_.end_of(line) - begin - 1, std::nullopt);
    for (std::size_t s = 0; s < near_.size(); ++s) {
      if (drawing_.is_left_out(begin + s)) continue;
      const bool has_length =
          drawing_.place(drawing_.point(begin + s)) != drawing_.place(drawing_.point(begin + s + 1));
      // A repeated point belongs to the stretch before it.
      if (has_length)
        near_[s] = measure(line, begin + s);
      else if (s > 0)
        near_[s] = near_[s - 1];
    }
  }

  /// Leaves out what repeats earlier lines of segments [first, end) of the line, all of them near such.
  void leave_out_run(std::size_t line, std::size_t first, std::size_t end) {
    const std::size_t begin = drawing_.begin_of(line), segments = near_.size();
    const auto length = [&](std::size_t s) { return drawing_.length(begin + s); };
    if (first > 0) {
      while (first < end && near_[first]->first - near_[first]->last > steepest * length(first)) ++first;
    }
    if (end < segments) {
      while (end > first && near_[end - 1]->last - near_[end - 1]->first > steepest * length(end - 1)) --end;
    }
    double together = 0, farthest = 0, radii = 0;
    for (std::size_t s = first; s < end; ++s) {
      together += length(s);
      farthest = std::max(farthest, near_[s]->largest);
      radii = std::max(radii, near_[s]->radii);
    }
    if (first == end || farthest > steepest * together) return;
    for (std::size_t s = first; s < end; ++s) drawing_.leave_out(begin + s);
    for (std::size_t p = first; p <= end; ++p) {
      const bool goes_on = (p == first && first > 0) || (p == end && end < segments);
      if (goes_on || drawing_.has_condition(drawing_.point(begin + p))) attach(line, begin + p);
    }
    segments_ += end - first;
    if (last_line_ != line) ++lines_;
    last_line_ = line;
    largest_distance_ = std::max(largest_distance_, farthest);
    largest_radii_ = std::max(largest_radii_, radii);
  }

  void attach(std::size_t line, std::size_t entry) {
    const double radius = drawing_.radius(entry);
    const auto to = drawn_near(line, drawing_.position(drawing_.point(entry)), radius);
    drawing_.attach(entry, *to);
  }

  void draw(std::size_t segment) {
    const std::size_t a = drawing_.point(segment), b = drawing_.point(segment + 1);
    if (drawing_.is_left_out(segment) || drawing_.place(a) == drawing_.place(b)) return;
    const double margin =
        drawing_.tolerance() * std::max(drawing_.radius(segment), drawing_.radius(segment + 1));
    drawn_.add(static_cast<std::uint32_t>(segment), drawing_.position(a), drawing_.position(b), margin);
  }

  std::vector<std::string> notes(double metres_per_unit) const {
    if (segments_ == 0) return {};
    std::vector<std::string> notes{fmt::format(
        "{} of {} repeat earlier lines and are left out (at most {} from them; network.merge_tolerance = {})",
        counted(segments_, "segment"), counted(lines_, "line"),
        quantity(largest_distance_ * metres_per_unit, "m"), text(drawing_.tolerance()))};
    if (largest_radii_ > 0.01)
      notes.push_back(
          fmt::format("radii of repeated lines differ by up to {:.0f} %: the first line's are taken",
                      100 * largest_radii_));
    return notes;
  }

  LineDrawing& drawing_;
  SegmentIndex drawn_;                          ///< the segments that are drawn, of lines so far
  std::vector<std::optional<Distances>> near_;  ///< [segments of a line] where they may repeat what is drawn
  std::size_t segments_ = 0, lines_ = 0;        ///< with repetitions
  std::size_t last_line_ = static_cast<std::size_t>(-1);
  double largest_distance_ = 0, largest_radii_ = 0;
};

}  // namespace

std::vector<std::string> leave_out_repetitions(LineDrawing& drawing, double metres_per_unit) {
  return Repetitions(drawing).leave_out(metres_per_unit);
}

}  // namespace rhexis::network::vtp
