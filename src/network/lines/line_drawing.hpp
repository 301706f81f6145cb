// SPDX-License-Identifier: BSD-3-Clause
/// The lines of a file with what is known of their joints while they are merged (line_merging.hpp): which
/// points are one place, which segments are left out, where lines are joined in the midst of a segment.
/// All lengths are in the file's unit.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "network/disjoint_sets.hpp"
#include "network/files/vtp/interface.hpp"
#include "network/lines/segment_index.hpp"

namespace rhexis::network::vtp {

/// Radii of the lumen: an array of cells or one of points, times `factor`.
struct LumenRadii {
  const Array *of_cells = nullptr, *of_points = nullptr;
  double factor = 1;
  /// What cannot be a radius counts as 0 here: nothing is near it.
  double at(std::size_t line, std::size_t point) const;
};

/// "1 line", "5 lines".
inline std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

class LineDrawing {
 public:
  /// A place on segment s, which joins the points connectivity[s] and connectivity[s + 1].
  struct Location {
    std::uint32_t segment = 0;
    double fraction = 0;  ///< of the segment's length, from its first point
    double distance = 0;  ///< from the point that was looked for
    double radius = 0;    ///< of the lumen there
  };

  /// `same`: [points] the first point of the file at the same position; `has_condition`: [points] whether
  /// something is known there, at first points.
  LineDrawing(Lines& lines, const LumenRadii& radii, double tolerance, std::vector<std::size_t> same,
              std::vector<char> has_condition);

  std::size_t points() const { return lines_.points(); }
  std::size_t lines() const { return lines_.lines(); }
  std::size_t begin_of(std::size_t line) const { return static_cast<std::size_t>(lines_.offsets[line]); }
  std::size_t end_of(std::size_t line) const { return static_cast<std::size_t>(lines_.offsets[line + 1]); }
  bool has_two_points(std::size_t line) const { return end_of(line) - begin_of(line) == 2; }
  std::size_t line_of(std::size_t segment) const { return line_of_[segment]; }
  /// The file's number of the segment's line.
  std::int64_t cell(std::size_t segment) const { return lines_.first_cell + line_of_[segment]; }
  std::size_t point(std::size_t entry) const { return static_cast<std::size_t>(lines_.connectivity[entry]); }
  Point position(std::size_t point) const;
  double radius(std::size_t entry) const { return radii_.at(line_of_[entry], point(entry)); }
  double length(std::size_t segment) const;
  double tolerance() const { return tolerance_; }

  /// The point that stands for all that are one place with `point`: the first of them.
  std::size_t place(std::size_t point) { return places_.of(point); }
  bool has_condition(std::size_t point) { return has_condition_[place(point)] != 0; }

  /// Makes one place of the point of an entry of the connectivity and of a location on a line: a point of
  /// that line where one is within the tolerance, else one that is put in between. Returns the place.
  std::size_t attach(std::size_t entry, const Location& to);
  /// Makes two points one place.
  std::size_t join(std::size_t a, std::size_t b);

  /// Whether the segment is a drawing of vessels that are there already. Segments of no length are neither.
  bool is_left_out(std::size_t segment) const { return left_out_[segment] != 0; }
  void leave_out(std::size_t segment) {
    left_out_[segment] = 1;
    is_changed_ = true;
  }
  /// Whether anything was left out or joined.
  bool is_changed() const { return is_changed_; }

  /// The nearest location to x on the segments of `index` for which `accept(segment)`, if its distance is at
  /// most `reach(radius there)`; of equal ones that of the first segment.
  template <class Accept, class Reach>
  std::optional<Location> nearest(const SegmentIndex& index, const Point& x, const Accept& accept,
                                  const Reach& reach) const {
    std::optional<Location> found;
    index.for_each_near(x, [&](std::uint32_t segment) {
      if (!accept(segment)) return;
      const Location at = closest(segment, x);
      if (!(at.distance <= reach(at.radius))) return;
      if (!found || std::pair(at.distance, segment) < std::pair(found->distance, found->segment)) found = at;
    });
    return found;
  }

  /// Gives the lines points where they are joined in the midst of segments, with the values of point arrays
  /// in between of the segment's ends'; conditions are nan there. Segments are numbered anew.
  void insert_points();
  /// [points] the place of each.
  std::vector<std::size_t> places();
  const std::vector<char>& left_out() const { return left_out_; }

 private:
  struct Insertion {
    double fraction;
    std::size_t place;
  };
  void note_lines();
  Location closest(std::uint32_t segment, const Point& x) const;
  std::size_t insert(const Location& at);

  Lines& lines_;
  const LumenRadii radii_;
  const double tolerance_;
  DisjointSets places_;
  std::vector<char> has_condition_;     ///< [points] at places
  std::vector<std::uint32_t> line_of_;  ///< [connectivity]
  std::vector<char> left_out_;          ///< [connectivity] the segment that begins there
  std::map<std::uint32_t, std::vector<Insertion>> insertions_;
  bool is_changed_ = false;
};

}  // namespace rhexis::network::vtp
