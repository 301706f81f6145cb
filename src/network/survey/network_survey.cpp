// SPDX-License-Identifier: BSD-3-Clause
#include "network/survey/network_survey.hpp"

#include <algorithm>
#include <cstdint>

#include "network/connectivity.hpp"

namespace rhexis::network {
namespace {

template <class Name>
void add(NamedCount& named, const Name& name) {
  if (named.count++ < most_named) named.names.push_back(name());
}

/// What there is at the conditions of a part.
struct PartConditions {
  std::uint32_t conditions = 0, openings = 0, pressures = 0;
};

/// [J] of the parts, at their first junctions.
std::vector<PartConditions> conditions_of_parts(const BoundedGraph& network,
                                                const std::vector<std::uint32_t>& part) {
  std::vector<PartConditions> all(network.graph.junctions);
  for (const BoundaryCondition& condition : network.conditions) {
    PartConditions& own = all[part[condition.junction]];
    ++own.conditions;
    own.openings += is_open(condition);
    own.pressures += condition.kind == BoundaryCondition::Kind::pressure;
  }
  return all;
}

void survey_junctions(NetworkSurvey& s, const BoundedGraph& network, const std::vector<std::uint32_t>& part,
                      const std::vector<PartConditions>& of_part) {
  const Graph& g = network.graph;
  std::vector<bool> has_condition(g.junctions);
  for (const BoundaryCondition& condition : network.conditions) has_condition[condition.junction] = true;
  const std::vector<std::uint32_t> degree = degrees(g);
  for (std::size_t j = 0; j < g.junctions; ++j) {
    const auto name = [&] { return g.name_of_junction(j); };
    const PartConditions& own = of_part[part[j]];
    if (degree[j] == 0) {
      add(s.isolated, name);
      continue;
    }
    if (degree[j] == 1) {
      ++s.ends;
      if (!has_condition[j] && own.conditions > 0) add(s.open_ends, name);
    }
    if (part[j] != j) continue;
    ++s.parts;
    if (own.pressures == 0) add(s.parts_without_pressure, name);
    if (own.conditions == 0) {
      add(s.parts_without_conditions, name);
    } else if (own.openings < 2) {
      add(s.parts_with_one_opening, name);
    }
  }
}

void survey_vessels(NetworkSurvey& s, const BoundedGraph& network, const std::vector<std::uint32_t>& part,
                    const std::vector<PartConditions>& of_part) {
  const Graph& g = network.graph;
  const std::vector<bool> carries = can_carry_flow(g, network.conditions);
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    const auto name = [&] { return g.name_of_vessel(v); };
    if (of_part[part[g.from[v]]].openings < 2) {
      ++s.vessels_without_way;
    } else if (!carries[v]) {
      add(s.dead_ends, name);
    }
    if (!g.knows_wall(v)) add(s.assumed_walls, name);
  }
}

MeasureRange range_of(const Graph& g, const std::vector<double>& measure) {
  if (measure.empty()) return {};
  const auto [least, largest] = std::ranges::minmax_element(measure);
  const auto name = [&](auto at) { return g.name_of_vessel(static_cast<std::size_t>(at - measure.begin())); };
  return {*least, *largest, name(least), name(largest)};
}

}  // namespace

NetworkSurvey survey_of(const BoundedGraph& network, const std::vector<std::uint32_t>& part) {
  const Graph& g = network.graph;
  NetworkSurvey s;
  s.vessels = g.vessels();
  s.junctions = g.junctions;
  s.conditions = network.conditions.size();
  s.notes = network.notes;
  s.warnings = network.warnings;
  const std::vector<PartConditions> of_part = conditions_of_parts(network, part);
  survey_junctions(s, network, part, of_part);
  survey_vessels(s, network, part, of_part);
  s.loops = s.vessels + s.parts + s.isolated.count - s.junctions;
  s.radius = range_of(g, g.radius);
  s.length = range_of(g, g.length);
  if (!g.x.empty()) {
    s.extent.emplace();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::ranges::minmax(k == 0 ? g.x : k == 1 ? g.y : g.z);
      (*s.extent)[k] = {low, high};
    }
  }
  return s;
}

}  // namespace rhexis::network
