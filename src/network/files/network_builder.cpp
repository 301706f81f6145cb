// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/network_builder.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::network {
namespace {

constexpr std::size_t most_items = 0xfffffffe;  ///< numbers of 32 bits

/// What is wrong with an id; empty: nothing.
std::string problem_of(const std::string& id) {
  if (id.empty()) return "id is missing";
  const bool control = std::ranges::any_of(id, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  return control ? "id = " + id + ": it has a control character" : "";
}

}  // namespace

void NetworkBuilder::refuse(const std::string& where, const std::string& problem) {
  throw InputError(where + ": " + problem);
}

void NetworkBuilder::add(const JunctionRow& row, const std::string& where) {
  Graph& g = network_.graph;
  if (const std::string problem = problem_of(row.id); !problem.empty()) refuse(where, problem);
  if (g.junctions >= most_items) refuse(where, "too many junctions; 4294967294 is the most");
  const auto number = static_cast<std::uint32_t>(g.junctions);
  if (const auto [found, isnew] = junctions_.try_emplace(row.id, number); !isnew) {
    refuse(where, "id = " + row.id + ": there is a junction of this id already, number " +
                      std::to_string(found->second + 1) + " of the file");
  }
  const int coordinates = row.x.has_value() + row.y.has_value() + row.z.has_value();
  if (coordinates != 0 && coordinates != 3)
    refuse(where, "junction " + row.id + ": give all of x, y, z or none");
  if (g.junctions > 0 && (coordinates == 3) != !g.x.empty()) {
    refuse(where, "junction " + row.id + ": either all junctions have coordinates or none");
  }
  if (coordinates == 3) {
    g.x.push_back(*row.x);
    g.y.push_back(*row.y);
    g.z.push_back(*row.z);
  }
  ++g.junctions;
  g.junction_name.push_back(row.id);
  if (row.pressure && row.flow) {
    refuse(where, "junction " + row.id + " has a pressure and a flow; give one of them");
  }
  if (row.resistance && !row.pressure) {
    refuse(where, "junction " + row.id + " has a resistance; give the pressure behind it too");
  }
  if (row.resistance && *row.resistance < 0) {
    refuse(where, "resistance of junction " + row.id + " is " + text(*row.resistance) +
                      " Pa s/m3: must be at least 0 Pa s/m3");
  }
  if (row.pressure) {
    network_.conditions.push_back(
        {number, BoundaryCondition::Kind::pressure, *row.pressure, row.resistance.value_or(0)});
  }
  if (row.flow) network_.conditions.push_back({number, BoundaryCondition::Kind::flow, *row.flow, 0});
}

std::uint32_t NetworkBuilder::junction(const std::string& id, const std::string& column,
                                       const std::string& where) const {
  const auto found = junctions_.find(id);
  if (found == junctions_.end()) refuse(where, column + " = " + id + ": there is no junction of this id");
  return found->second;
}

double NetworkBuilder::length_of(const VesselRow& row, std::uint32_t from, std::uint32_t to,
                                 const std::string& where) const {
  const Graph& g = network_.graph;
  if (row.length) return *row.length;
  if (g.x.empty()) refuse(where, "vessel " + row.id + " needs a length, as junctions have no coordinates");
  return std::hypot(g.x[from] - g.x[to], g.y[from] - g.y[to], g.z[from] - g.z[to]);
}

void NetworkBuilder::add(const VesselRow& row, const std::string& where) {
  Graph& g = network_.graph;
  if (const std::string problem = problem_of(row.id); !problem.empty()) refuse(where, problem);
  if (g.vessels() >= most_items) refuse(where, "too many vessels; 4294967294 is the most");
  const auto number = static_cast<std::uint32_t>(g.vessels());
  if (const auto [found, isnew] = vessels_.try_emplace(row.id, number); !isnew) {
    refuse(where, "id = " + row.id + ": there is a vessel of this id already, number " +
                      std::to_string(found->second + 1) + " of the file");
  }
  const std::uint32_t from = junction(row.from, "from", where), to = junction(row.to, "to", where);
  if (from == to) refuse(where, "vessel " + row.id + " leads from junction " + row.from + " to itself");
  const auto positive = [&](const char* what, std::optional<double> value) {
    if (!value) refuse(where, std::string(what) + " of vessel " + row.id + " is missing");
    if (!(*value >= smallest_measure && *value <= largest_measure)) {
      refuse(where, std::string(what) + " of vessel " + row.id + " is " + text(*value) +
                        " m: must be at least " + text(smallest_measure) + " m and at most " +
                        text(largest_measure) + " m");
    }
    return *value;
  };
  g.radius.push_back(positive("radius", row.radius));
  g.length.push_back(positive("length", length_of(row, from, to, where)));
  g.wall_thickness.push_back(row.wall_thickness ? positive("wall thickness", row.wall_thickness) : 0);
  VesselKind kind = VesselKind::unknown;
  if (row.kind == "artery") kind = VesselKind::artery;
  if (row.kind == "vein") kind = VesselKind::vein;
  if (kind == VesselKind::unknown && !row.kind.empty() && row.kind != "unknown") {
    refuse(where, "kind = " + row.kind + ": must be artery, vein or unknown");
  }
  const double generation = row.generation.value_or(-1);
  if (row.generation && !(generation >= 0 && generation <= 127 && generation == std::floor(generation))) {
    refuse(where, "generation = " + text(generation) + ": must be a whole number from 0 to 127");
  }
  g.from.push_back(from);
  g.to.push_back(to);
  g.kind.push_back(kind);
  g.generation.push_back(static_cast<std::int8_t>(generation));
  g.vessel_name.push_back(row.id);
}

BoundedGraph NetworkBuilder::finish(const std::string& file) {
  const Graph& g = network_.graph;
  if (g.vessels() == 0) throw InputError(file + ": there are no vessels");
  std::vector<bool> has_vessel(g.junctions);
  for (const auto& ends : {g.from, g.to}) {
    for (const std::uint32_t j : ends) has_vessel[j] = true;
  }
  for (const BoundaryCondition& c : network_.conditions) {
    if (!has_vessel[c.junction]) {
      throw InputError(file + ": junction " + g.name_of_junction(c.junction) +
                       ", where a pressure or a flow is given, is no vessel's end");
    }
  }
  return std::move(network_);
}

}  // namespace rhexis::network
