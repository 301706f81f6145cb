// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/format.hpp"
#include "network/lines/line_merging.hpp"

namespace rhexis::network::vtp {
namespace {

/// A gap at the free end of a line is at most this part of the line's length: a short stub that ends beside
/// the junction that it comes from has no gap there.
constexpr double widest_gap = 0.1;
constexpr std::size_t most_named = 5;

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

class Gaps {
 public:
  Gaps(LineDrawing& drawing, double metres_per_unit)
      : drawing_(drawing),
        metres_per_unit_(metres_per_unit),
        visits_(drawing.points()),
        parts_(drawing.places()) {}

  std::vector<std::string> close() {
    for (std::size_t line = 0; line < drawing_.lines(); ++line) read(line);
    const bool one_part = std::ranges::all_of(
        ends_, [&](const End& end) { return part_of(end.entry) == part_of(ends_.front().entry); });
    std::erase_if(ends_, [&](const End& end) {
      return drawing_.has_condition(drawing_.point(end.entry)) || (one_part && !is_free(end));
    });
    if (ends_.empty()) return {};
    SegmentIndex index(drawn_.size());
    for (const std::uint32_t s : drawn_) {
      index.add(s, drawing_.position(drawing_.point(s)), drawing_.position(drawing_.point(s + 1)),
                std::max(drawing_.radius(s), drawing_.radius(s + 1)));
    }
    join_ends(index);
    return notes();
  }

 private:
  using Location = LineDrawing::Location;
  /// An end of a stretch, that is of what is drawn of a line between segments that are left out.
  struct End {
    std::size_t entry, other;  ///< of the connectivity: the end, and the stretch's other end
    double length;             ///< of the stretch
  };
  struct Gap {
    End end;
    Location to;
  };

  /// Counts the visits of a line to places, joins these to parts of the network, and lists ends and segments.
  void read(std::size_t line) {
    const std::size_t end = drawing_.end_of(line);
    for (std::size_t s = drawing_.begin_of(line); s + 1 < end; ++s) {
      const std::size_t first = s;
      double length = 0;
      for (; s + 1 < end && !drawing_.is_left_out(s); ++s) {
        const std::size_t a = place(s), b = place(s + 1);
        if (a == b) continue;
        if (length == 0) ++visits_[a];
        ++visits_[b];
        parts_.join(a, b);
        length += drawing_.length(s);
        drawn_.push_back(static_cast<std::uint32_t>(s));
      }
      if (length == 0) continue;
      ends_.push_back({first, s, length});
      ends_.push_back({s, first, length});
    }
  }

  std::size_t place(std::size_t entry) { return drawing_.place(drawing_.point(entry)); }
  std::size_t part_of(std::size_t entry) { return parts_.of(place(entry)); }
  bool is_free(const End& end) { return visits_[place(end.entry)] == 1; }

  /// Whether a line may be joined to another one at its end.
  bool may_join(const End& end, const Location& to) {
    if (drawing_.line_of(to.segment) == drawing_.line_of(end.entry)) return false;
    if (part_of(to.segment) != part_of(end.entry)) return true;
    return is_free(end) && to.distance <= widest_gap * end.length;
  }

  template <class Reach>
  std::optional<Location> nearest(const SegmentIndex& index, const End& end, const Reach& reach) {
    const auto found = drawing_.nearest(
        index, drawing_.position(drawing_.point(end.entry)),
        [&](std::uint32_t segment) {
          return drawing_.line_of(segment) != drawing_.line_of(end.entry) &&
                 (is_free(end) || part_of(segment) != part_of(end.entry));
        },
        reach);
    return found && may_join(end, *found) ? found : std::nullopt;
  }

  /// The nearest first: an end that another one has joined is free no more.
  void join_ends(const SegmentIndex& index) {
    std::vector<Gap> gaps;
    for (const End& end : ends_) {
      const double radius = drawing_.radius(end.entry);
      const auto near = [&](double there) { return drawing_.tolerance() * std::min(radius, there); };
      const auto in_lumen = [&](double there) { return std::max(radius, there); };
      if (const auto to = nearest(index, end, near))
        gaps.push_back({end, *to});
      else if (const auto miss = nearest(index, end, in_lumen))
        misses_.push_back({end, *miss});
    }
    std::ranges::sort(gaps, {}, [](const Gap& g) { return std::pair(g.to.distance, g.end.entry); });
    for (const Gap& gap : gaps) {
      if (may_join(gap.end, gap.to) && !closes_on_itself(gap)) join(gap);
    }
    std::erase_if(misses_, [&](const Gap& miss) { return !may_join(miss.end, miss.to); });
  }

  /// Whether the other end of the line would be joined to the same place.
  bool closes_on_itself(const Gap& gap) {
    const Point end = drawing_.position(drawing_.point(gap.end.entry));
    const Point other = drawing_.position(drawing_.point(gap.end.other));
    return distance(end, other) <=
           2 * drawing_.tolerance() * std::max(drawing_.radius(gap.end.entry), gap.to.radius);
  }

  void join(const Gap& gap) {
    const std::size_t from = place(gap.end.entry), line = place(gap.to.segment);
    const std::size_t joined = drawing_.attach(gap.end.entry, gap.to);
    parts_.join(joined, from);
    parts_.join(joined, line);
    visits_[joined] = 2;
    ++closed_;
    widest_ = std::max(widest_, gap.to.distance);
  }

  std::vector<std::string> notes() {
    std::vector<std::string> notes;
    if (closed_ > 0) {
      notes.push_back(fmt::format("{} of at most {} (network.merge_tolerance = {})",
                                  closed_ == 1 ? "1 end of a line is joined across a gap"
                                               : counted(closed_, "end") + " of lines are joined across gaps",
                                  quantity(widest_ * metres_per_unit_, "m"), text(drawing_.tolerance())));
    }
    if (misses_.empty()) return notes;
    std::string named;
    for (std::size_t i = 0; i < std::min(misses_.size(), most_named); ++i) {
      const auto& [end, to] = misses_[i];
      named += fmt::format("{}point {} ends {} from cell {}", i == 0 ? "" : "; ", drawing_.point(end.entry),
                           quantity(to.distance * metres_per_unit_, "m"), drawing_.cell(to.segment));
    }
    if (misses_.size() > most_named) named += fmt::format(" and {} more", misses_.size() - most_named);
    notes.push_back(fmt::format(
        "{} of lines in the lumen of another line, beyond network.merge_tolerance = {} radii, not joined to "
        "it: {}",
        misses_.size() == 1 ? "1 end" : counted(misses_.size(), "end"), text(drawing_.tolerance()), named));
    return notes;
  }

  LineDrawing& drawing_;
  const double metres_per_unit_;
  std::vector<std::uint32_t> visits_;  ///< [points] of places
  DisjointSets parts_;                 ///< of places, that lines join
  std::vector<std::uint32_t> drawn_;   ///< segments
  std::vector<End> ends_;
  std::vector<Gap> misses_;  ///< ends in the lumen of another line
  std::size_t closed_ = 0;
  double widest_ = 0;
};

}  // namespace

std::vector<std::string> close_gaps(LineDrawing& drawing, double metres_per_unit) {
  return Gaps(drawing, metres_per_unit).close();
}

}  // namespace rhexis::network::vtp
