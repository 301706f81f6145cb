// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/swc_network.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "core/error.hpp"
#include "core/faults.hpp"
#include "core/printable.hpp"
#include "core/scanning.hpp"
#include "network/files/network_file.hpp"
#include "network/lines/line_network.hpp"

namespace rhexis::network {
namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

struct SwcPoint {
  std::int64_t id, parent;
  Point position;
  double radius;
  std::size_t line;  ///< of the file, from 1
};

class SwcFile {
 public:
  explicit SwcFile(const std::filesystem::path& path) : file_(path.string()), text_(read_network_text(path)) {
    read_points();
    faults_.raise();
    if (points_.empty()) throw InputError(file_ + ": there are no points");
    find_parents();
    find_rings();
    faults_.raise();
  }

  vtp::Lines lines() const {
    vtp::Lines lines;
    vtp::Array radius{"radius", 1, false, {}};
    for (const SwcPoint& p : points_) {
      lines.coordinates.insert(lines.coordinates.end(), p.position.begin(), p.position.end());
      lines.point_names.push_back(std::to_string(p.id));
      radius.values.push_back(p.radius);
    }
    lines.point_arrays.push_back(std::move(radius));
    // Each line is followed from its end up to where it begins; it is stored the other way round.
    for (std::size_t end = 0; end < points_.size(); ++end) {
      if (parent_[end] == none || !is_end(end)) continue;
      std::vector<std::int64_t> line{static_cast<std::int64_t>(end)};
      std::size_t p = end;
      do {
        p = parent_[p];
        line.push_back(static_cast<std::int64_t>(p));
      } while (!is_end(p));
      lines.connectivity.insert(lines.connectivity.end(), line.rbegin(), line.rend());
      lines.offsets.push_back(static_cast<std::int64_t>(lines.connectivity.size()));
      lines.line_names.push_back(std::to_string(points_[end].id));
    }
    return lines;
  }

 private:
  /// A point at which lines end: a root, a branching or a tip.
  bool is_end(std::size_t p) const { return parent_[p] == none || children_[p] != 1; }

  std::string where(std::size_t line) const { return fmt::format("{}:{}", file_, line); }

  void read_points() {
    std::string_view rest = text_;
    for (std::size_t line = 1; !rest.empty(); ++line) {
      const std::size_t end = rest.find('\n');
      std::string_view row = rest.substr(0, end);
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      row = row.substr(0, row.find('#'));
      if (row.find_first_not_of(separators) == std::string_view::npos) continue;
      faults_.collect([&] { points_.push_back(read_point(row, line)); });
    }
  }

  SwcPoint read_point(std::string_view row, std::size_t line) const {
    constexpr std::array names{"id", "type", "x", "y", "z", "radius", "parent"};
    std::array<double, names.size()> fields{};
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::size_t begin = row.find_first_not_of(separators);
      if (begin == std::string_view::npos)
        throw InputError(
            fmt::format("{}: {} fields, 7 are expected: id type x y z radius parent", where(line), i));
      row.remove_prefix(begin);
      const std::string_view field = row.substr(0, row.find_first_of(separators));
      row.remove_prefix(field.size());
      const std::optional<double> value = finite_number(field);
      const bool is_id = i == 0 || i + 1 == names.size();
      if (!value || (is_id && (*value != std::floor(*value) || std::abs(*value) > largest_id)))
        throw InputError(fmt::format("{}: {} = {}: not a {} number", where(line), names[i],
                                     printable(field, 40), is_id ? "whole" : "finite"));
      fields[i] = *value;
    }
    if (!(fields[5] > 0))
      throw InputError(fmt::format("{}: radius = {}: must be above 0", where(line), fields[5]));
    return {static_cast<std::int64_t>(fields[0]),
            static_cast<std::int64_t>(fields[6]),
            {fields[2], fields[3], fields[4]},
            fields[5],
            line};
  }

  void find_parents() {
    std::unordered_map<std::int64_t, std::size_t> of_id;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const auto [found, is_new] = of_id.try_emplace(points_[p].id, p);
      if (!is_new)
        faults_.add(fmt::format("{}: id = {}: line {} has it too", where(points_[p].line), points_[p].id,
                                points_[found->second].line));
    }
    parent_.assign(points_.size(), none);
    children_.assign(points_.size(), 0);
    for (std::size_t p = 0; p < points_.size(); ++p) {
      if (points_[p].parent == -1) continue;
      const auto found = of_id.find(points_[p].parent);
      if (found == of_id.end()) {
        faults_.add(fmt::format("{}: parent = {}: no point has this id (-1: none)", where(points_[p].line),
                                points_[p].parent));
        continue;
      }
      parent_[p] = found->second;
      ++children_[found->second];
    }
  }

  /// From every point the parents lead to a root, lest lines have no end.
  void find_rings() {
    std::vector<std::size_t> walk(points_.size());  // the last point, from 1, from which each was met
    for (std::size_t start = 0; start < points_.size(); ++start) {
      std::size_t p = start;
      for (; p != none && walk[p] == 0; p = parent_[p]) walk[p] = start + 1;
      if (p != none && walk[p] == start + 1)
        faults_.add(fmt::format("{}: parent = {}: the point would be its own ancestor",
                                where(points_[p].line), points_[p].parent));
    }
  }

  static constexpr std::string_view separators = " \t\r,";
  static constexpr double largest_id = 9e15;  // whole numbers up to here are exact
  const std::string file_;
  const std::string text_;
  Faults faults_;
  std::vector<SwcPoint> points_;
  std::vector<std::size_t> parent_;      ///< [points]
  std::vector<std::uint32_t> children_;  ///< [points] how many
};

}  // namespace

BoundedGraph read_swc_network(const std::filesystem::path& path, double metres_per_unit,
                              double merge_tolerance) {
  return network_of_lines(SwcFile(path).lines(), path.string(), metres_per_unit, merge_tolerance);
}

}  // namespace rhexis::network
