// SPDX-License-Identifier: BSD-3-Clause
#include "network/lines/line_drawing.hpp"

#include <algorithm>

namespace rhexis::network::vtp {

double LumenRadii::at(std::size_t line, std::size_t point) const {
  const double value = factor * (of_cells != nullptr ? of_cells->values[line] : of_points->values[point]);
  return value > 0 && std::isfinite(value) ? value : 0;
}

LineDrawing::LineDrawing(Lines& lines, const LumenRadii& radii, double tolerance,
                         std::vector<std::size_t> same, std::vector<char> has_condition)
    : lines_(lines),
      radii_(radii),
      tolerance_(tolerance),
      places_(std::move(same)),
      has_condition_(std::move(has_condition)),
      left_out_(lines.connectivity.size()) {
  note_lines();
}

void LineDrawing::note_lines() {
  line_of_.resize(lines_.connectivity.size());
  for (std::size_t l = 0; l < lines(); ++l)
    std::fill(line_of_.begin() + lines_.offsets[l], line_of_.begin() + lines_.offsets[l + 1],
              static_cast<std::uint32_t>(l));
}

Point LineDrawing::position(std::size_t point) const {
  const double* x = &lines_.coordinates[3 * point];
  return {x[0], x[1], x[2]};
}

double LineDrawing::length(std::size_t segment) const {
  const Point a = position(point(segment)), b = position(point(segment + 1));
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

LineDrawing::Location LineDrawing::closest(std::uint32_t segment, const Point& x) const {
  const Point a = position(point(segment)), b = position(point(segment + 1));
  double along = 0, square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    along += (x[k] - a[k]) * (b[k] - a[k]);
    square += (b[k] - a[k]) * (b[k] - a[k]);
  }
  const double t = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
  const auto off = [&](std::size_t k) { return x[k] - (t == 1 ? b[k] : a[k] + t * (b[k] - a[k])); };
  return {segment, t, std::hypot(off(0), off(1), off(2)), std::lerp(radius(segment), radius(segment + 1), t)};
}

std::size_t LineDrawing::join(std::size_t a, std::size_t b) {
  is_changed_ = true;
  const char known = has_condition_[place(a)] | has_condition_[place(b)];
  const std::size_t place = places_.join(a, b);
  has_condition_[place] = known;
  return place;
}

std::size_t LineDrawing::attach(std::size_t entry, const Location& to) {
  is_changed_ = true;
  const Point x = position(point(entry));
  const double near = tolerance_ * std::min(radius(entry), to.radius);
  const auto distance = [&](std::size_t p) {
    const Point y = position(p);
    return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
  };
  std::vector<std::size_t> points{point(to.segment), point(to.segment + 1)};
  std::vector<Insertion>* inserted = nullptr;
  if (const auto found = insertions_.find(to.segment); found != insertions_.end()) {
    inserted = &found->second;
    for (const Insertion& insertion : *inserted) points.push_back(insertion.place);
  }
  const std::size_t closest = *std::ranges::min_element(points, {}, distance);
  if (distance(closest) <= near) return join(point(entry), closest);
  if (inserted == nullptr) inserted = &insertions_[to.segment];
  inserted->push_back({to.fraction, point(entry)});
  return place(point(entry));
}

void LineDrawing::insert_points() {
  if (insertions_.empty()) return;
  std::vector<std::int64_t> connectivity, offsets{0};
  std::vector<char> left_out;
  for (std::size_t l = 0; l < lines(); ++l) {
    for (std::size_t entry = begin_of(l); entry < end_of(l); ++entry) {
      connectivity.push_back(lines_.connectivity[entry]);
      left_out.push_back(left_out_[entry]);
      const auto found = insertions_.find(static_cast<std::uint32_t>(entry));
      if (found == insertions_.end()) continue;
      std::ranges::sort(found->second, {}, [](const Insertion& i) { return std::pair(i.fraction, i.place); });
      for (const Insertion& insertion : found->second) {
        connectivity.push_back(static_cast<std::int64_t>(
            insert({.segment = static_cast<std::uint32_t>(entry), .fraction = insertion.fraction})));
        join(insertion.place, static_cast<std::size_t>(connectivity.back()));
        left_out.push_back(left_out_[entry]);
      }
    }
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  lines_.connectivity = std::move(connectivity);
  lines_.offsets = std::move(offsets);
  left_out_ = std::move(left_out);
  insertions_.clear();
  note_lines();
}

/// Adds a point to the lines; returns its number.
std::size_t LineDrawing::insert(const Location& at) {
  const std::size_t a = point(at.segment), b = point(at.segment + 1), added = lines_.points();
  for (std::size_t k = 0; k < 3; ++k)
    lines_.coordinates.push_back(std::lerp(position(a)[k], position(b)[k], at.fraction));
  for (Array& array : lines_.point_arrays) {
    const auto components = static_cast<std::size_t>(array.components);
    const bool is_condition = array.name.ends_with("_condition");
    for (std::size_t c = 0; c < components; ++c) {
      const double between =
          std::lerp(array.values[a * components + c], array.values[b * components + c], at.fraction);
      array.values.push_back(is_condition ? std::numeric_limits<double>::quiet_NaN() : between);
    }
  }
  if (!lines_.point_names.empty()) lines_.point_names.emplace_back();
  places_.add();
  has_condition_.push_back(0);
  return added;
}

std::vector<std::size_t> LineDrawing::places() {
  std::vector<std::size_t> all(lines_.points());
  for (std::size_t p = 0; p < all.size(); ++p) all[p] = place(p);
  return all;
}

}  // namespace rhexis::network::vtp
