// SPDX-License-Identifier: BSD-3-Clause
#include "network/repair/wall_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::network {
namespace {

/// "wall_range[2].ratio", of the second section.
std::string key_of(std::size_t section, const char* name) {
  return fmt::format("wall_range[{}].{}", section + 1, name);
}

/// The first radius (m) above the range.
double end_of(const WallRange& range) {
  return range.radius_to.value_or(std::numeric_limits<double>::infinity());
}

/// "below 5 um", "from 5 um to 10 um", "from 10 um".
std::string radii_text(const WallRange& range) {
  if (range.radius_from == 0 && range.radius_to) return "below " + quantity(*range.radius_to, "m");
  return fmt::format("from {}{}", quantity(range.radius_from, "m"),
                     range.radius_to ? " to " + quantity(*range.radius_to, "m") : "");
}

/// Throws InputError where the ranges of vessels of that kind overlap or leave a gap.
void check_neighbours(const std::vector<WallRange>& ranges, VesselKind kind) {
  std::vector<std::size_t> sections;  // by ascending radius
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (ranges[i].is_about(kind)) sections.push_back(i);
  std::ranges::stable_sort(sections, {}, [&](std::size_t i) { return ranges[i].radius_from; });
  for (std::size_t k = 1; k < sections.size(); ++k) {
    const std::size_t below = sections[k - 1], above = sections[k];
    const double end = end_of(ranges[below]), begin = ranges[above].radius_from;
    if (begin == end) continue;
    const bool is_gap = begin > end;
    throw InputError(
        fmt::format("{} wall_range[{}], radii {}: each range must begin where the one below it ends",
                    is_gap ? "leaves a gap above" : "overlaps with", below + 1, radii_text(ranges[below])),
        key_of(above, "radius_from"));
  }
}

}  // namespace

bool WallRange::holds(double radius) const {
  constexpr double rounded_up = 1 + 1e-9;
  return radius * rounded_up >= radius_from && radius * rounded_up < end_of(*this);
}

bool WallRange::is_about(VesselKind of_vessel) const {
  return kind.empty() || (kind == "vein") == (of_vessel == VesselKind::vein);
}

ParameterList declare(std::vector<WallRange>& ranges) {
  return {
      {.key = "wall_range.radius_from",
       .target = ListTarget(&ranges, &WallRange::radius_from),
       .unit = "m",
       .default_in = "um",
       .meaning = "The wall of vessels of a network from files by ranges of the lumen's radius, where the "
                  "files tell no thickness: of this radius and wider. Ranges may not overlap or leave gaps "
                  "between them; below and above them the rules of [wall] hold.",
       .range = Range::not_negative()},
      {.key = "wall_range.radius_to",
       .target = ListTarget(&ranges, &WallRange::radius_to),
       .unit = "m",
       .meaning = "The first radius above the range; \"auto\": there is no limit.",
       .range = Range::positive()},
      {.key = "wall_range.kind",
       .target = ListTarget(&ranges, &WallRange::kind),
       .meaning = "Vessels that are meant: \"artery\" (with those of unknown kind, as in wall.artery_rule) "
                  "or \"vein\"; without it all.",
       .choices = {"artery", "vein"}},
      {.key = "wall_range.thickness",
       .target = ListTarget(&ranges, &WallRange::thickness),
       .unit = "m",
       .meaning = "Wall thickness there; or give wall_range.ratio.",
       .range = Range::between(smallest_measure, largest_measure)},
      {.key = "wall_range.ratio",
       .target = ListTarget(&ranges, &WallRange::ratio),
       .unit = "1",
       .meaning = "Wall thickness there over the radius of the lumen.",
       .range = Range::positive()},
  };
}

void check(const std::vector<WallRange>& ranges) {
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const WallRange& range = ranges[i];
    if (range.thickness.has_value() == range.ratio.has_value())
      throw InputError("give one of wall_range.thickness and wall_range.ratio", key_of(i, "thickness"));
    if (range.radius_to && !(*range.radius_to > range.radius_from))
      throw InputError("must be above wall_range.radius_from, " + quantity(range.radius_from, "m"),
                       key_of(i, "radius_to"));
  }
  for (const VesselKind kind : {VesselKind::artery, VesselKind::vein}) check_neighbours(ranges, kind);
}

void set_wall_ranges(const std::vector<WallRange>& ranges, BoundedGraph& network) {
  if (ranges.empty()) return;
  Graph& g = network.graph;
  g.wall_thickness.resize(g.vessels());
  std::vector<std::size_t> vessels_of(ranges.size());
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    if (g.knows_wall(v)) continue;
    const VesselKind kind = g.kind.empty() ? VesselKind::unknown : g.kind[v];
    const auto range = std::ranges::find_if(
        ranges, [&](const WallRange& r) { return r.is_about(kind) && r.holds(g.radius[v]); });
    if (range == ranges.end()) continue;
    g.wall_thickness[v] = range->thickness_at(g.radius[v]);
    ++vessels_of[static_cast<std::size_t>(range - ranges.begin())];
  }
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const WallRange& range = ranges[i];
    network.notes.push_back(fmt::format(
        "wall_range[{}] gives the walls of {} vessel{} of radius {}{}: {}", i + 1,
        grouped(static_cast<long long>(vessels_of[i])), vessels_of[i] == 1 ? "" : "s", radii_text(range),
        range.kind.empty() ? "" : ", kind " + range.kind,
        range.thickness ? quantity(*range.thickness, "m") : text(*range.ratio) + " of the radius"));
  }
}

}  // namespace rhexis::network
