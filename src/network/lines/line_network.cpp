// SPDX-License-Identifier: BSD-3-Clause
#include "network/lines/line_network.hpp"

#include <functional>
#include <limits>

#include "network/lines/line_reading.hpp"

namespace rhexis::network {
namespace vtp {

/// Calls `use(points)` for every stretch of a line between segments that are left out, with its points
/// without repetitions one after the other.
template <class Use>
void Reading::for_each_stretch(std::size_t line, const Use& use) const {
  std::vector<std::size_t> points;
  const auto end = static_cast<std::size_t>(lines_.offsets[line + 1]);
  for (auto entry = static_cast<std::size_t>(lines_.offsets[line]); entry < end; ++entry) {
    const auto p = static_cast<std::size_t>(lines_.connectivity[entry]);
    if (points.empty() || same_[points.back()] != same_[p]) points.push_back(p);
    if (entry + 1 < end && left_out_[entry] == 0) continue;
    if (points.size() > 1) use(points);
    points.clear();
  }
}

void Reading::count_visits() {
  visits_.assign(lines_.points(), 0);
  for (std::size_t l = 0; l < lines_.lines(); ++l) {
    for_each_stretch(l, [&](std::span<const std::size_t> points) {
      for (const std::size_t p : points) ++visits_[same_[p]];
    });
  }
}

double Reading::radius_at(std::size_t point) const {
  return positive(point_radius_->values[point], point_radius_->name.c_str(), "point",
                  static_cast<std::int64_t>(point));
}

bool Reading::constant_radius(std::span<const std::size_t> run) const {
  if (cell_radius_ != nullptr) return true;
  const double first = radius_at(run.front());
  return std::all_of(run.begin(), run.end(),
                     [&](std::size_t p) { return std::abs(radius_at(p) - first) <= 1e-12 * first; });
}

double Reading::span_length(std::span<const std::size_t> run) const {
  double length = 0;
  for (std::size_t i = 1; i < run.size(); ++i) {
    const double *a = &lines_.coordinates[3 * same_[run[i - 1]]], *b = &lines_.coordinates[3 * same_[run[i]]];
    length += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  }
  return length;
}

void Reading::add_line(std::size_t line) {
  const std::size_t first_vessel = from_.size();
  for_each_stretch(line, [&](std::span<const std::size_t> points) { add_stretch(line, points); });
  if (length_ != nullptr) share_length(line, first_vessel);
}

/// Cuts a stretch of a line into vessels.
void Reading::add_stretch(std::size_t line, std::span<const std::size_t> points) {
  std::size_t begin = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const std::size_t p = same_[points[i]];
    if (i + 1 < points.size() && visits_[p] == 1 && has_condition_[p] == 0) continue;
    const auto run = points.subspan(begin, i - begin + 1);
    if (constant_radius(run)) {
      add_vessel(line, run);
    } else {
      for (std::size_t piece = 0; piece + 1 < run.size(); ++piece) add_vessel(line, run.subspan(piece, 2));
    }
    begin = i;
  }
}

/// Shares the length that the file gives the whole line out among its vessels, by their lengths as drawn.
void Reading::share_length(std::size_t line, std::size_t first_vessel) {
  auto& length = result_.graph.length;
  double drawn = 0;
  bool whole = length.size() == first_vessel + 1;
  for (auto entry = lines_.offsets[line]; entry + 1 < lines_.offsets[line + 1]; ++entry) {
    const std::size_t ends[] = {
        static_cast<std::size_t>(lines_.connectivity[static_cast<std::size_t>(entry)]),
        static_cast<std::size_t>(lines_.connectivity[static_cast<std::size_t>(entry) + 1])};
    drawn += span_length(ends);
    whole = whole && left_out_[static_cast<std::size_t>(entry)] == 0;
  }
  const double given = of_cell(*length_, line) * unit_;
  for (std::size_t v = first_vessel; v < length.size(); ++v)
    length[v] = whole ? given : given * (length[v] / (drawn * unit_));
}

void Reading::add_vessel(std::size_t line, std::span<const std::size_t> run) {
  const std::size_t from = same_[run.front()], to = same_[run.back()];
  if (from == to && is_merged_)
    return;  // it left another line and came back to the same place: nothing flows
  if (from == to) return drop_self_loop(line, from);
  from_.push_back(from);
  to_.push_back(to);
  line_.push_back(line);
  Graph& graph = result_.graph;
  if (cell_radius_ != nullptr) {
    graph.radius.push_back(of_cell(*cell_radius_, line) * radius_factor_ * unit_);
  } else {
    const double a = radius_at(run.front()), b = radius_at(run.back());
    graph.radius.push_back((constant_radius(run) ? a : tapered_radius(a, b)) * radius_factor_ * unit_);
  }
  graph.length.push_back(positive(span_length(run) * unit_, "length", "cell", cell(line)));
  if (wall_ != nullptr) graph.wall_thickness.push_back(of_cell(*wall_, line) * unit_);
  if (kind_ != nullptr) graph.kind.push_back(static_cast<VesselKind>(whole_number(*kind_, line, 0, 2)));
  if (generation_ != nullptr)
    graph.generation.push_back(static_cast<std::int8_t>(whole_number(*generation_, line, -1, 127)));
}

/// A line, or a piece of one, leads from a point to itself.
void Reading::drop_self_loop(std::size_t line, std::size_t point) {
  if (!drops_self_loops_)
    fail_at_cell(line, fmt::format("a line from point {} to itself (network.drop = [\"self_loops\"] leaves "
                                   "such lines out)",
                                   point));
  if (self_loops_++ == 0) first_self_loop_ = line;
}

void Reading::note_self_loops() {
  if (self_loops_ > 0)
    result_.notes.push_back(fmt::format(
        "{}: {} lines that lead from a point to itself are left out (network.drop); the first is cell {}",
        file_, self_loops_, cell(first_self_loop_)));
}

void Reading::check_measures() const {
  const Graph& graph = result_.graph;
  const auto check = [&](const char* name, const std::vector<double>& values) {
    const auto found = std::ranges::find_if(
        values, [](double value) { return !(value >= smallest_measure && value <= largest_measure); });
    if (found == values.end()) return;
    const bool large = *found > largest_measure;
    fail_at_cell(line_[static_cast<std::size_t>(found - values.begin())],
                 fmt::format("{} is {} m, {} {} m: is network.file_length_unit right?", name, *found,
                             large ? "above" : "below", large ? largest_measure : smallest_measure));
  };
  check("radius", graph.radius);
  check("length", graph.length);
  check("wall thickness", graph.wall_thickness);
}

double Reading::whole_number(const Array& array, std::size_t line, double low, double high) const {
  const double value = array.values[line];
  if (value >= low && value <= high && value == std::floor(value)) return value;
  fail_at_cell(line, fmt::format("{} is {}, not one of {} .. {}", array.name, value, low, high));
}

/// Junctions are the ends of vessels, in the order of points.
void Reading::number_junctions() {
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  Graph& graph = result_.graph;
  std::vector<std::uint32_t> number(lines_.points(), none);
  for (const auto& ends : {std::cref(from_), std::cref(to_)}) {
    for (const std::size_t p : ends.get()) number[p] = 0;
  }
  const bool has_names = !lines_.point_names.empty();
  bool renumbered = has_names;
  for (std::size_t p = 0; p < number.size(); ++p) {
    if (number[p] == none) continue;
    renumbered = renumbered || p != graph.junctions;
    if (graph.junctions == none) fail("too many junctions");
    number[p] = static_cast<std::uint32_t>(graph.junctions++);
    graph.x.push_back(lines_.coordinates[3 * p] * unit_);
    graph.y.push_back(lines_.coordinates[3 * p + 1] * unit_);
    graph.z.push_back(lines_.coordinates[3 * p + 2] * unit_);
    graph.junction_name.push_back(has_names ? lines_.point_names[p] : std::to_string(p));
  }
  if (!renumbered) graph.junction_name.clear();
  for (const std::size_t p : from_) graph.from.push_back(number[p]);
  for (const std::size_t p : to_) graph.to.push_back(number[p]);
  for (BoundaryCondition condition : condition_) {
    const std::uint32_t point = condition.junction;
    condition.junction = number[point];
    if (condition.junction == none) fail(fmt::format("point {}: a condition, but no line goes there", point));
    result_.conditions.push_back(condition);
  }
}

/// A vessel is named as its cell, with the number of the piece where the cell was cut.
void Reading::name_vessels() {
  bool renumbered = !lines_.line_names.empty();
  std::vector<std::string>& names = result_.graph.vessel_name;
  for (std::size_t v = 0; v < line_.size();) {
    std::size_t end = v;
    while (end < line_.size() && line_[end] == line_[v]) ++end;
    renumbered = renumbered || end != v + 1 || cell(line_[v]) != static_cast<std::int64_t>(v);
    const std::string name =
        lines_.line_names.empty() ? std::to_string(cell(line_[v])) : lines_.line_names[line_[v]];
    for (std::size_t piece = 0; piece < end - v; ++piece)
      names.push_back(end == v + 1 ? name : fmt::format("{}.{}", name, piece));
    v = end;
  }
  if (!renumbered) names.clear();
}

}  // namespace vtp

double tapered_radius(double a, double b) {
  // The power is taken of the ratio, lest a small radius' sixth power underflow.
  const double t = b / a;
  return a * std::pow(3 * t * t * t / (1 + t + t * t), 0.25);
}

BoundedGraph network_of_lines(vtp::Lines lines, const std::string& file, double metres_per_unit,
                              double merge_tolerance, bool drops_self_loops) {
  return vtp::Reading(std::move(lines), file, metres_per_unit, merge_tolerance, drops_self_loops).network();
}

}  // namespace rhexis::network
