// SPDX-License-Identifier: BSD-3-Clause
// Segments of centre lines that continue each other become one vessel.
#include <array>
#include <limits>

#include "network/lines/line_reading.hpp"

namespace rhexis::network::vtp {
namespace {

constexpr auto none = std::numeric_limits<std::size_t>::max();

/// A vessel of several segments, in the order in which they follow each other from `begin` to `end`.
struct Branch {
  std::size_t begin = none, end = none;                       ///< points
  std::vector<std::pair<std::size_t, std::size_t>> segments;  ///< each with the point that it begins at
};

/// Follows segments, which are known by the points that they join.
class Branches {
 public:
  /// `may_join(a, b, point)`: whether two segments that meet at a point, and no other with them, are one.
  template <class MayJoin>
  Branches(const std::vector<std::size_t>& from, const std::vector<std::size_t>& to, std::size_t points,
           const MayJoin& may_join)
      : from_(from), to_(to), joint_(points, {none, none}), taken_(from.size()) {
    std::vector<std::uint32_t> degree(points);
    for (std::size_t s = 0; s < from.size(); ++s) {
      for (const std::size_t p : {from[s], to[s]})
        if (const std::uint32_t count = degree[p]++; count < 2) joint_[p][count] = s;
    }
    for (std::size_t p = 0; p < points; ++p) {
      if (degree[p] != 2 || !may_join(joint_[p][0], joint_[p][1], p)) joint_[p] = {none, none};
    }
  }

  bool is_taken(std::size_t segment) const { return taken_[segment] != 0; }

  /// The branch that a segment is part of; the segment alone where its branch would end where it begins.
  Branch take(std::size_t segment) {
    std::size_t first = segment, begin = from_[segment];
    while (continues(begin)) {
      const std::size_t before = other(begin, first);
      if (before == segment) break;  // a ring
      begin = far_end(before, begin);
      first = before;
    }
    Branch branch{begin, begin, {}};
    for (std::size_t s = first;;) {
      branch.segments.emplace_back(s, branch.end);
      branch.end = far_end(s, branch.end);
      if (branch.end == begin || !continues(branch.end)) break;
      s = other(branch.end, s);
    }
    if (branch.end == begin) branch = {from_[segment], to_[segment], {{segment, from_[segment]}}};
    for (const auto& [s, start] : branch.segments) taken_[s] = 1;
    return branch;
  }

 private:
  bool continues(std::size_t point) const { return joint_[point][0] != none; }
  std::size_t other(std::size_t point, std::size_t segment) const {
    return joint_[point][joint_[point][0] == segment ? 1 : 0];
  }
  std::size_t far_end(std::size_t segment, std::size_t point) const {
    return from_[segment] == point ? to_[segment] : from_[segment];
  }

  const std::vector<std::size_t>&from_, &to_;
  std::vector<std::array<std::size_t, 2>> joint_;  ///< [points] the two segments that are one there, or none
  std::vector<char> taken_;                        ///< [segments]
};

}  // namespace

void Reading::join_branches() {
  bool has_centre_lines = false;
  for (std::size_t l = 0; l < lines_.lines(); ++l)
    has_centre_lines = has_centre_lines || lines_.offsets[l + 1] - lines_.offsets[l] > 2;
  if (!has_centre_lines) return;
  const Graph segments = std::move(result_.graph);
  const std::vector<std::size_t> from = std::move(from_), to = std::move(to_), line = std::move(line_);
  from_.clear(), to_.clear(), line_.clear();
  result_.graph = {};
  const auto alike = [&](const auto& values, std::size_t a, std::size_t b) {
    return values.empty() || values[a] == values[b];
  };
  Branches branches(from, to, lines_.points(), [&](std::size_t a, std::size_t b, std::size_t p) {
    return a != b && has_condition_[p] == 0 && alike(segments.wall_thickness, a, b) &&
           alike(segments.kind, a, b) && alike(segments.generation, a, b);
  });
  for (std::size_t s = 0; s < from.size(); ++s) {
    if (branches.is_taken(s)) continue;
    const Branch branch = branches.take(s);
    from_.push_back(branch.begin);
    to_.push_back(branch.end);
    line_.push_back(line[s]);
    Graph& graph = result_.graph;
    double length = 0, area = 0;
    std::vector<VesselPiece> pieces;
    for (const auto& [segment, start] : branch.segments) {
      const double *x = &lines_.coordinates[3 * start], r = segments.radius[segment];
      pieces.push_back({r, segments.length[segment], {x[0] * unit_, x[1] * unit_, x[2] * unit_}});
      length += pieces.back().length;
      area += r * pieces.back().length;
    }
    const bool is_whole = pieces.size() == 1;
    graph.radius.push_back(is_whole ? pieces[0].radius : area / length);
    graph.length.push_back(length);
    graph.add_pieces(is_whole ? std::span<const VesselPiece>() : pieces);
    if (!segments.wall_thickness.empty()) graph.wall_thickness.push_back(segments.wall_thickness[s]);
    if (!segments.kind.empty()) graph.kind.push_back(segments.kind[s]);
    if (!segments.generation.empty()) graph.generation.push_back(segments.generation[s]);
  }
  if (result_.graph.piece.empty()) result_.graph.first_piece.clear();
}

}  // namespace rhexis::network::vtp
