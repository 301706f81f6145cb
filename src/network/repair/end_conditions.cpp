// SPDX-License-Identifier: BSD-3-Clause
#include "network/repair/end_conditions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/error.hpp"
#include "core/format.hpp"
#include "network/condition_limits.hpp"
#include "network/connectivity.hpp"
#include "network/names.hpp"

namespace rhexis::network {
namespace {

/// "condition[2].flow", of the second section.
std::string key_of(std::size_t section, const char* name) {
  return fmt::format("condition[{}].{}", section + 1, name);
}

/// The end nearest to a point, and how far it is.
struct NearestEnd {
  std::uint32_t junction = 0;
  double distance = std::numeric_limits<double>::infinity();  ///< m
};

NearestEnd nearest_end(const Graph& g, const std::vector<std::uint32_t>& degree,
                       const std::vector<double>& point) {
  NearestEnd nearest;
  for (std::uint32_t j = 0; j < g.junctions; ++j) {
    if (degree[j] != 1) continue;
    const double distance = std::hypot(g.x[j] - point[0], g.y[j] - point[1], g.z[j] - point[2]);
    if (distance < nearest.distance) nearest = {j, distance};
  }
  return nearest;
}

/// The junctions of the conditions, found by what these say of them.
class Places {
 public:
  explicit Places(BoundedGraph& network) : network_(network) {}

  std::uint32_t find(const EndCondition& condition, std::size_t section) {
    if (condition.nearest.empty()) {
      const std::string key = key_of(section, "junction");
      std::optional<std::uint32_t> found;
      check_key(key.c_str(), [&] { found = find_junction(network_.graph, condition.junction); });
      if (!found) throw InputError("there is no junction of this id or name in " + network_.file, key);
      return *found;
    }
    const std::string key = key_of(section, "nearest");
    const Graph& g = network_.graph;
    if (g.x.empty()) throw InputError("needs coordinates of the junctions, and the files have none", key);
    if (degree_.empty()) degree_ = degrees(g);
    const NearestEnd end = nearest_end(g, degree_, condition.nearest);
    if (std::isinf(end.distance)) throw InputError("the network has no ends: no junction of one vessel", key);
    network_.notes.push_back(fmt::format("condition[{}] is at junction {}, {} from the point that is given",
                                         section + 1, g.name_of_junction(end.junction),
                                         quantity(end.distance, "m", 3)));
    return end.junction;
  }

 private:
  BoundedGraph& network_;
  std::vector<std::uint32_t> degree_;  ///< [J] vessels of a junction, once they are needed
};

}  // namespace

ParameterList declare(std::vector<EndCondition>& conditions) {
  return {
      {.key = "condition.junction",
       .target = ListTarget(&conditions, &EndCondition::junction),
       .meaning = "Id or name of a junction at which something is known, in the place of what the network's "
                  "files say there; or give condition.nearest."},
      {.key = "condition.nearest",
       .target = ListTarget(&conditions, &EndCondition::nearest),
       .unit = "m",
       .meaning = "A point, x, y and z, of which the nearest end of the network is meant (a junction of one "
                  "vessel)."},
      {.key = "condition.pressure",
       .target = ListTarget(&conditions, &EndCondition::pressure),
       .unit = "Pa",
       .meaning = "Pressure there, relative to atmosphere."},
      {.key = "condition.resistance",
       .target = ListTarget(&conditions, &EndCondition::resistance),
       .unit = "Pa s/m3",
       .meaning = "Resistance of a peripheral bed behind which the pressure lies.",
       .range = Range::not_negative()},
      {.key = "condition.flow",
       .target = ListTarget(&conditions, &EndCondition::flow),
       .unit = "m3/s",
       .meaning = "Flow into the network there, in the place of a pressure; negative: out of it."},
      {.key = "condition.haematocrit",
       .target = ListTarget(&conditions, &EndCondition::haematocrit),
       .unit = "1",
       .meaning = "Discharge haematocrit of the blood that enters there.",
       .range = Range::between(0, highest_haematocrit)},
  };
}

void check(const std::vector<EndCondition>& conditions) {
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const EndCondition& c = conditions[i];
    if (c.junction.empty() == c.nearest.empty())
      throw InputError("give one of condition.junction and condition.nearest", key_of(i, "junction"));
    if (!c.nearest.empty() && c.nearest.size() != 3)
      throw InputError("a point has three coordinates, as in [\"1 mm\", \"0 mm\", \"2 mm\"]",
                       key_of(i, "nearest"));
    if (c.pressure && c.flow) throw InputError("give a pressure or a flow, not both", key_of(i, "flow"));
    if (c.resistance && !c.pressure)
      throw InputError("give the pressure behind it too", key_of(i, "resistance"));
    if (!c.pressure && !c.flow && !c.haematocrit)
      throw InputError("give a pressure, a flow or a haematocrit there", key_of(i, "junction"));
    using Kind = BoundaryCondition::Kind;
    const std::string problem = c.pressure ? impossible_condition(Kind::pressure, *c.pressure)
                                : c.flow   ? impossible_condition(Kind::flow, *c.flow)
                                           : std::string();
    if (!problem.empty()) throw InputError(problem, key_of(i, c.pressure ? "pressure" : "flow"));
  }
}

void set_end_conditions(const std::vector<EndCondition>& conditions, BoundedGraph& network) {
  if (conditions.empty()) return;
  std::unordered_map<std::uint32_t, std::size_t> of_junction;  // numbers in network.conditions
  for (std::size_t i = 0; i < network.conditions.size(); ++i) of_junction[network.conditions[i].junction] = i;
  std::unordered_map<std::uint32_t, std::size_t> sections;
  Places places(network);
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const EndCondition& given = conditions[i];
    const char* name = given.nearest.empty() ? "junction" : "nearest";
    const std::uint32_t j = places.find(given, i);
    if (const auto [found, isnew] = sections.try_emplace(j, i); !isnew)
      throw InputError(fmt::format("junction {} has a condition already, of condition[{}]",
                                   network.graph.name_of_junction(j), found->second + 1),
                       key_of(i, name));
    const auto [known, is_added] = of_junction.try_emplace(j, network.conditions.size());
    if (is_added && !given.pressure && !given.flow)
      throw InputError(fmt::format("junction {} has neither a pressure nor a flow; give one",
                                   network.graph.name_of_junction(j)),
                       key_of(i, "haematocrit"));
    if (is_added) network.conditions.push_back({.junction = j});
    BoundaryCondition& condition = network.conditions[known->second];
    if (given.pressure || given.flow) {
      condition.kind = given.pressure ? BoundaryCondition::Kind::pressure : BoundaryCondition::Kind::flow;
      condition.value = given.pressure ? *given.pressure : *given.flow;
      condition.resistance = given.resistance.value_or(0);
    }
    if (given.haematocrit) condition.haematocrit = given.haematocrit;
  }
}

void refuse_directed_ends(BoundedGraph& network) {
  std::erase_if(network.directed_ends, [&](std::uint32_t j) {
    return std::ranges::find(network.conditions, j, &BoundaryCondition::junction) != network.conditions.end();
  });
  const std::size_t count = network.directed_ends.size();
  if (count == 0) return;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min<std::size_t>(count, 12); ++i)
    names.push_back(network.graph.name_of_junction(network.directed_ends[i]));
  throw InputError(
      fmt::format("{}: only the direction of the flow is told at {} end{}: {}{}. Directions settle no flow: "
                  "each of these "
                  "ends needs a pressure or the amount of the flow, in the file or by [[condition]]",
                  network.file, count, count == 1 ? "" : "s", fmt::join(names, ", "),
                  count > names.size() ? fmt::format(" and {} more", count - names.size()) : ""));
}

}  // namespace rhexis::network
