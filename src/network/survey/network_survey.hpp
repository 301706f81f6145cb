// SPDX-License-Identifier: BSD-3-Clause
/// What a network is like before anything is solved: its parts, its ends, the vessels that will carry no
/// flow, and the ranges of its measures. It is told by `rhexis check`, `run` and `network` of a user's own
/// network.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "network/graph.hpp"

namespace rhexis::network {

/// How many junctions, vessels or parts there are of a kind, and the names of the first few.
struct NamedCount {
  std::size_t count = 0;
  std::vector<std::string> names;  ///< of the first `most_named`
};

/// A list in a message is no longer than this.
inline constexpr std::size_t most_named = 5;

/// The least and the largest of a vessel's measure (m), and the vessels that have them.
struct MeasureRange {
  double least = 0, largest = 0;
  std::string least_vessel, largest_vessel;
};

struct NetworkSurvey {
  std::size_t vessels = 0, junctions = 0;
  std::size_t conditions = 0;
  std::size_t parts = 0;                ///< connected components that have vessels
  std::size_t loops = 0;                ///< independent ones: vessels - junctions + parts
  NamedCount isolated;                  ///< junctions without vessels
  NamedCount parts_without_pressure;    ///< parts where no condition is a pressure, by their first junctions
  NamedCount parts_without_conditions;  ///< those of them without any condition
  NamedCount parts_with_one_opening;    ///< parts with conditions, but fewer than two where blood may pass
  std::size_t ends = 0;                 ///< junctions of degree 1
  NamedCount open_ends;                 ///< ends without a condition in parts that have one
  /// Vessels that carry no flow whatever the values of the conditions: dead ends and loops that hang at one
  /// junction, in parts with flow; all vessels of the other parts.
  NamedCount dead_ends;
  std::size_t vessels_without_way = 0;
  MeasureRange radius, length;
  std::optional<std::array<std::pair<double, double>, 3>> extent;  ///< m, of x, y, z; none: no coordinates
  NamedCount assumed_walls;  ///< vessels whose thickness is not given: the rules of [wall] give it
  std::vector<std::string> notes, warnings;  ///< what the reading has told: those of BoundedGraph

  std::size_t without_flow() const { return dead_ends.count + vessels_without_way; }
};

/// `part`: [J] as of first_of_part. Takes O(J + V).
NetworkSurvey survey_of(const BoundedGraph& network, const std::vector<std::uint32_t>& part);

}  // namespace rhexis::network
