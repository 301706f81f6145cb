// SPDX-License-Identifier: BSD-3-Clause
/// Walls by ranges of radius, [[wall_range]], for vessels of which the network's own files tell no thickness.
/// Where no range holds a radius the rules of [wall] do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "network/graph.hpp"

namespace rhexis::network {

/// A section [[wall_range]]: the wall of vessels with radius_from <= radius < radius_to.
struct WallRange {
  double radius_from = 0;                ///< m
  std::optional<double> radius_to = {};  ///< m; none: no limit
  std::string kind = {};                 ///< "artery" (and what is no vein), "vein"; empty: both
  std::optional<double> thickness = {};  ///< m
  std::optional<double> ratio = {};      ///< thickness over the radius of the lumen

  /// Whether it is about vessels of that kind, at any radius.
  bool is_about(VesselKind of_vessel) const;
  /// Whether a radius (m) is in it; one that is a limit but for rounding counts as that limit.
  bool holds(double radius) const;
  /// Wall thickness (m) of a vessel of `radius` (m).
  double thickness_at(double radius) const { return thickness ? *thickness : *ratio * radius; }
};

ParameterList declare(std::vector<WallRange>& ranges);

/// Throws InputError with the key at fault for a range without radii or without one of thickness and ratio,
/// for ranges of one kind that overlap, and for a gap between two of them.
void check(const std::vector<WallRange>& ranges);

/// Gives every vessel without a wall thickness that of its range, if it is in one. A note of each range tells
/// how many vessels it has given a wall.
void set_wall_ranges(const std::vector<WallRange>& ranges, BoundedGraph& network);

}  // namespace rhexis::network
