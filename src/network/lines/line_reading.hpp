// SPDX-License-Identifier: BSD-3-Clause
/// The work behind line_network.hpp: what the file has (line_points.cpp) and how it is cut
/// (line_network.cpp), and which segments are one vessel (line_branches.cpp).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "network/files/vtp/interface.hpp"
#include "network/graph.hpp"

namespace rhexis::network::vtp {

class Reading {
 public:
  Reading(Lines lines, const std::string& file, double metres_per_unit, double merge_tolerance,
          bool drops_self_loops)
      : lines_(std::move(lines)),
        file_(file),
        unit_(metres_per_unit),
        tolerance_(merge_tolerance),
        drops_self_loops_(drops_self_loops) {}

  BoundedGraph network() {
    check_lines();
    find_arrays();
    merge_points();
    merge_lines();
    find_conditions();
    count_visits();
    for (std::size_t l = 0; l < lines_.lines(); ++l) add_line(l);
    if (from_.empty()) fail("there are no vessels: each line leads from a point to itself");
    check_measures();
    join_branches();
    number_junctions();
    name_vessels();
    note_self_loops();
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(file_ + ": " + what); }
  [[noreturn]] void fail_at_cell(std::size_t line, const std::string& what) const {
    fail(fmt::format("cell {}: {}", cell(line), what));
  }
  std::int64_t cell(std::size_t line) const { return lines_.first_cell + static_cast<std::int64_t>(line); }

  double positive(double value, const char* name, const char* where, std::int64_t number) const {
    if (!(value > 0) || !std::isfinite(value))
      fail(fmt::format("{} {}: {} is {}, not positive and finite", where, number, name, value));
    return value;
  }
  double of_cell(const Array& array, std::size_t line) const {
    return positive(array.values[line], array.name.c_str(), "cell", cell(line));
  }

  const Array* find(const std::vector<Array>& arrays, const std::string& name) const {
    const auto found =
        std::find_if(arrays.begin(), arrays.end(), [&](const Array& a) { return a.name == name; });
    if (found == arrays.end()) return nullptr;
    if (found->components != 1)
      fail(fmt::format("array {} has {} components, not 1", name, found->components));
    return &*found;
  }

  void check_lines() const;
  void find_arrays();
  std::string array_list() const;
  void merge_points();
  void merge_lines();
  void find_conditions();
  std::vector<double> values_at_places(const Array& array) const;
  void add_condition(const Array& array, BoundaryCondition::Kind kind);
  void add_haematocrits();
  void count_visits();
  template <class Use>
  void for_each_stretch(std::size_t line, const Use& use) const;
  void add_line(std::size_t line);
  void add_stretch(std::size_t line, std::span<const std::size_t> points);
  void share_length(std::size_t line, std::size_t first_vessel);
  double radius_at(std::size_t point) const;
  bool constant_radius(std::span<const std::size_t> run) const;
  double span_length(std::span<const std::size_t> run) const;
  void add_vessel(std::size_t line, std::span<const std::size_t> run);
  void drop_self_loop(std::size_t line, std::size_t point);
  void note_self_loops();
  void check_measures() const;
  void join_branches();
  double whole_number(const Array& array, std::size_t line, double low, double high) const;
  void number_junctions();
  void name_vessels();

  Lines lines_;
  const std::string& file_;
  const double unit_, tolerance_;
  const bool drops_self_loops_;
  const Array *cell_radius_ = nullptr, *point_radius_ = nullptr;
  double radius_factor_ = 1;  ///< 1/2 of a diameter
  const Array *length_ = nullptr, *wall_ = nullptr, *kind_ = nullptr, *generation_ = nullptr;
  std::vector<std::size_t> same_;             ///< [point] the first point at its place
  std::vector<char> left_out_;                ///< [connectivity] the segment repeats what is there already
  std::vector<std::size_t> visits_;           ///< [point] by lines, of first points
  std::vector<BoundaryCondition> condition_;  ///< junctions still numbered as points
  std::vector<char> has_condition_;           ///< [point]
  std::vector<std::size_t> from_, to_;        ///< [vessel] as points
  std::vector<std::size_t> line_;             ///< [vessel]
  bool is_merged_ = false;                    ///< whether lines were joined or left out
  std::size_t self_loops_ = 0, first_self_loop_ = 0;  ///< lines that are left out
  BoundedGraph result_;
};

}  // namespace rhexis::network::vtp
