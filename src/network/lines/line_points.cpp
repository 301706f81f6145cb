// SPDX-License-Identifier: BSD-3-Clause
// What a VTP file has: lines that name points, arrays, points at one place, conditions.
#include <array>
#include <limits>
#include <numeric>

#include "network/condition_limits.hpp"
#include "network/lines/line_merging.hpp"
#include "network/lines/line_reading.hpp"

namespace rhexis::network::vtp {
namespace {

constexpr std::array radius_names{"radius", "Radius", "MaximumInscribedSphereRadius", "diameter", "Diameter"};
constexpr std::array condition_names{"pressure_condition", "flow_condition"};

}  // namespace

void Reading::check_lines() const {
  if (lines_.lines() == 0) fail(fmt::format("no lines (but {} points)", lines_.points()));
  for (std::size_t p = 0; p < lines_.points(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!std::isfinite(lines_.coordinates[3 * p + c]))
        fail(fmt::format("point {}: position not finite", p));
    }
  }
  for (std::size_t l = 0; l < lines_.lines(); ++l) {
    const auto begin = lines_.offsets[l], end = lines_.offsets[l + 1];
    if (end - begin < 2) fail_at_cell(l, fmt::format("a line of {} points; it takes two", end - begin));
    for (auto i = begin; i < end; ++i) {
      const auto p = lines_.connectivity[static_cast<std::size_t>(i)];
      if (p < 0 || static_cast<std::size_t>(p) >= lines_.points())
        fail_at_cell(l, fmt::format("names point {}, of {} (0 is the first)", p, lines_.points()));
    }
  }
}

std::string Reading::array_list() const {
  std::string list;
  const auto append = [&](const std::vector<Array>& arrays, const char* of) {
    for (const Array& array : arrays)
      list += fmt::format("{}{} (of {})", list.empty() ? "" : ", ", array.name, of);
  };
  append(lines_.point_arrays, "points");
  append(lines_.cell_arrays, "cells");
  return list.empty() ? "none" : list;
}

void Reading::find_arrays() {
  for (const std::string name : radius_names) {
    cell_radius_ = find(lines_.cell_arrays, name);
    if (cell_radius_ == nullptr) point_radius_ = find(lines_.point_arrays, name);
    if (cell_radius_ == nullptr && point_radius_ == nullptr) continue;
    if (name == "diameter" || name == "Diameter") radius_factor_ = 0.5;
    break;
  }
  if (cell_radius_ == nullptr && point_radius_ == nullptr) {
    fail(fmt::format("no radius: one of the arrays {} is needed, of points or cells; there are: {}",
                     fmt::join(radius_names, ", "), array_list()));
  }
  length_ = find(lines_.cell_arrays, "length");
  wall_ = find(lines_.cell_arrays, "wall_thickness");
  kind_ = find(lines_.cell_arrays, "kind");
  generation_ = find(lines_.cell_arrays, "generation");
}

void Reading::merge_points() {
  std::vector<std::size_t> order(lines_.points());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto place = [&](std::size_t p) {
    const double* x = &lines_.coordinates[3 * p];
    return std::array{x[0], x[1], x[2]};
  };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return place(a) < place(b); });
  same_.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeated = i > 0 && place(order[i]) == place(order[i - 1]);
    same_[order[i]] = repeated ? same_[order[i - 1]] : order[i];
  }
  for (std::size_t l = 0; l < lines_.lines(); ++l) {
    const std::span points(&lines_.connectivity[static_cast<std::size_t>(lines_.offsets[l])],
                           static_cast<std::size_t>(lines_.offsets[l + 1] - lines_.offsets[l]));
    const auto at_first = [&](std::int64_t p) {
      return same_[static_cast<std::size_t>(p)] == same_[static_cast<std::size_t>(points.front())];
    };
    if (std::ranges::all_of(points, at_first)) drop_self_loop(l, static_cast<std::size_t>(points.front()));
  }
}

void Reading::merge_lines() {
  std::vector<char> has_condition(lines_.points());
  for (const char* name : condition_names) {
    const Array* array = find(lines_.point_arrays, name);
    for (std::size_t p = 0; array != nullptr && p < lines_.points(); ++p) {
      if (!std::isnan(array->values[p])) has_condition[same_[p]] = 1;
    }
  }
  LineDrawing drawing(lines_, {cell_radius_, point_radius_, radius_factor_}, tolerance_, std::move(same_),
                      std::move(has_condition));
  const auto note = [&](std::vector<std::string> notes) {
    for (std::string& sentence : notes) result_.notes.push_back(std::move(sentence));
    drawing.insert_points();
  };
  note(leave_out_repetitions(drawing, unit_));
  note(close_gaps(drawing, unit_));
  is_merged_ = drawing.is_changed();
  same_ = drawing.places();
  left_out_ = drawing.left_out();
}

void Reading::find_conditions() {
  has_condition_.assign(lines_.points(), 0);
  const Array* pressure = find(lines_.point_arrays, condition_names[0]);
  const Array* flow = find(lines_.point_arrays, condition_names[1]);
  if (pressure != nullptr) add_condition(*pressure, BoundaryCondition::Kind::pressure);
  if (flow != nullptr) add_condition(*flow, BoundaryCondition::Kind::flow);
  add_haematocrits();
}

/// [point] the values of an array at the first points of their places; nan where nothing is known.
std::vector<double> Reading::values_at_places(const Array& array) const {
  std::vector<double> known(lines_.points(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t p = 0; p < lines_.points(); ++p) {
    const double value = array.values[p];
    if (std::isnan(value)) continue;
    if (std::isinf(value)) fail(fmt::format("point {}: {} is {}", p, array.name, value));
    double& at_place = known[same_[p]];
    if (!std::isnan(at_place) && at_place != value)
      fail(fmt::format("points {} and {}, at one place: {} is {} and {}", same_[p], p, array.name, at_place,
                       value));
    at_place = value;
  }
  return known;
}

void Reading::add_condition(const Array& array, BoundaryCondition::Kind kind) {
  const std::vector<double> known = values_at_places(array);
  for (std::size_t p = 0; p < lines_.points(); ++p) {
    if (std::isnan(known[p])) continue;
    if (has_condition_[p] != 0) fail(fmt::format("point {}: both a pressure and a flow condition", p));
    if (const std::string problem = impossible_condition(kind, known[p]); !problem.empty())
      fail(fmt::format("point {}: {}", p, problem));
    has_condition_[p] = 1;
    condition_.push_back({static_cast<std::uint32_t>(p), kind, known[p], 0});
  }
}

/// Gives conditions the haematocrits of the blood that enters there.
void Reading::add_haematocrits() {
  const Array* array = find(lines_.point_arrays, "haematocrit_condition");
  if (array == nullptr) return;
  std::vector<double> known = values_at_places(*array);
  for (std::size_t p = 0; p < known.size(); ++p) {
    if (!std::isnan(known[p]) && !(known[p] >= 0 && known[p] <= highest_haematocrit))
      fail(fmt::format("point {}: {} is {}, not a fraction from 0 to {}", p, array->name, known[p],
                       highest_haematocrit));
  }
  for (BoundaryCondition& condition : condition_) {
    double& haematocrit = known[condition.junction];
    if (std::isnan(haematocrit)) continue;
    condition.haematocrit = haematocrit;
    haematocrit = std::numeric_limits<double>::quiet_NaN();
  }
  const auto idle = std::ranges::count_if(known, [](double value) { return !std::isnan(value); });
  if (idle > 0)
    result_.notes.push_back(
        fmt::format("{}: {} points with a haematocrit, but neither a pressure nor a flow, at which it is not "
                    "used",
                    file_, idle));
}

}  // namespace rhexis::network::vtp
