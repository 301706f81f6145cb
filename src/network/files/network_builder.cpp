// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/network_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/format.hpp"
#include "network/condition_limits.hpp"
#include "network/connectivity.hpp"
#include "network/names.hpp"

namespace rhexis::network {
namespace {

constexpr std::size_t most_items = 0xfffffffe;  ///< numbers of 32 bits
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// What is wrong with an id; empty: nothing.
std::string problem_of(const std::string& id) {
  if (id.empty()) return "id is missing";
  const bool control = std::ranges::any_of(id, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  return control ? "id = " + id + ": it has a control character" : "";
}

/// Adds the `name` of item `number` to a list that stays empty as long as there are no names.
void add_label(std::vector<std::string>& labels, std::size_t number, const std::string& name) {
  if (name.empty() && labels.empty()) return;
  labels.resize(number);
  labels.push_back(name);
}

}  // namespace

const Columns& junction_columns() {
  static const Columns columns{{"id", ""},
                               {"name", "", {"label"}},
                               {"x", "m", {"pos_x"}},
                               {"y", "m", {"pos_y"}},
                               {"z", "m", {"pos_z"}},
                               {"pressure", "Pa"},
                               {"flow", "m3/s"},
                               {"resistance", "Pa s/m3"},
                               {"haematocrit", "1", {"hematocrit", "hd"}}};
  return columns;
}

const Columns& vessel_columns() {
  static const Columns columns{{"id", ""},
                               {"name", "", {"label"}},
                               {"from", "", {"source", "node1id", "left_vertex_id"}},
                               {"to", "", {"target", "node2id", "right_vertex_id"}},
                               {"radius", "m", {"avgRadiusAvg"}},
                               {"diameter", "m"},
                               {"length", "m", {"vessel_length"}},
                               {"wall_thickness", "m"},
                               {"kind", ""},
                               {"generation", "1"}};
  return columns;
}

bool is_direction(std::string_view text) {
  constexpr std::string_view directions[] = {"in",     "out",     "inlet",  "outlet",
                                             "inflow", "outflow", "source", "sink"};
  return std::ranges::find(directions, spelling(text)) != std::end(directions);
}

void NetworkBuilder::refuse(const std::string& where, const std::string& problem) {
  throw InputError(where + ": " + problem);
}

void NetworkBuilder::mention_junction(const std::string& id) {
  Graph& g = network_.graph;
  if (id.empty()) return lose_junction();
  if (!junctions_.try_emplace(std::string(canonical_id(id)), static_cast<std::uint32_t>(g.junctions)).second)
    return;
  ++g.junctions;
  g.junction_name.push_back(id);
  for (auto* coordinate : {&g.x, &g.y, &g.z}) coordinate->push_back(unknown);
}

void NetworkBuilder::add(const JunctionRow& row, const std::string& where) {
  Graph& g = network_.graph;
  if (const std::string problem = problem_of(row.id); !problem.empty()) refuse(where, problem);
  if (g.junctions >= most_items) refuse(where, "too many junctions; 4294967294 is the most");
  const auto number = static_cast<std::uint32_t>(g.junctions);
  const auto [found, isnew] = junctions_.try_emplace(std::string(canonical_id(row.id)), number);
  if (!isnew) {
    refuse(where, "id = " + row.id + ": there is a junction of this id already, number " +
                      std::to_string(found->second + 1) + " of the file");
  }
  ++g.junctions;
  g.junction_name.push_back(row.id);
  add_label(g.junction_label, number, row.name);
  g.x.push_back(row.x.value_or(unknown));
  g.y.push_back(row.y.value_or(unknown));
  g.z.push_back(row.z.value_or(unknown));
  const int coordinates = row.x.has_value() + row.y.has_value() + row.z.has_value();
  if (coordinates != 0 && coordinates != 3)
    refuse(where, "junction " + row.id + ": give all of x, y, z or none");
  if (has_coordinates_.value_or(coordinates == 3) != (coordinates == 3))
    refuse(where, "junction " + row.id + ": either all junctions have coordinates or none");
  has_coordinates_ = coordinates == 3;
  add_condition(row, number, where);
}

void NetworkBuilder::add_condition(const JunctionRow& row, std::uint32_t junction, const std::string& where) {
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
  if (row.haematocrit && !(*row.haematocrit >= 0 && *row.haematocrit <= highest_haematocrit)) {
    refuse(where, "haematocrit of junction " + row.id + " is " + text(*row.haematocrit) +
                      ": must be a fraction, at least 0 and at most " + text(highest_haematocrit));
  }
  using Kind = BoundaryCondition::Kind;
  if (row.pressure || row.flow) {
    const std::string problem = row.pressure ? impossible_condition(Kind::pressure, *row.pressure)
                                             : impossible_condition(Kind::flow, *row.flow);
    if (!problem.empty()) refuse(where, "junction " + row.id + ": " + problem);
    network_.conditions.push_back({.junction = junction,
                                   .kind = row.pressure ? Kind::pressure : Kind::flow,
                                   .value = row.pressure ? *row.pressure : *row.flow,
                                   .resistance = row.resistance.value_or(0),
                                   .haematocrit = row.haematocrit});
  } else if (row.tells_direction) {
    network_.directed_ends.push_back(junction);
  } else if (row.haematocrit) {
    idle_haematocrits_.push_back(row.id);
  }
}

std::uint32_t NetworkBuilder::junction(const std::string& id, const std::string& column,
                                       const std::string& where) const {
  const auto found = junctions_.find(std::string(canonical_id(id)));
  if (found != junctions_.end()) return found->second;
  if (id.empty()) refuse(where, column + " is missing");
  if (!lost_junctions_) refuse(where, column + " = " + id + ": there is no junction of this id");
  return 0;
}

double NetworkBuilder::length_of(const VesselRow& row, std::uint32_t from, std::uint32_t to,
                                 const std::string& where) const {
  const Graph& g = network_.graph;
  if (row.length) return *row.length;
  if (!has_coordinates_.value_or(true))
    refuse(where, "vessel " + row.id + " needs a length, as junctions have no coordinates");
  if (from >= g.junctions || to >= g.junctions) return unknown;
  return std::hypot(g.x[from] - g.x[to], g.y[from] - g.y[to], g.z[from] - g.z[to]);
}

void NetworkBuilder::add(const VesselRow& row, const std::string& where, std::uint32_t line) {
  Graph& g = network_.graph;
  if (const std::string problem = problem_of(row.id); !problem.empty()) refuse(where, problem);
  if (g.vessels() >= most_items) refuse(where, "too many vessels; 4294967294 is the most");
  const auto number = static_cast<std::uint32_t>(vessels_.size());
  if (const auto [found, isnew] = vessels_.try_emplace(std::string(canonical_id(row.id)), number); !isnew) {
    refuse(where, "id = " + row.id + ": there is a vessel of this id already, number " +
                      std::to_string(found->second + 1) + " of the file");
  }
  const std::uint32_t from = junction(row.from, "from", where), to = junction(row.to, "to", where);
  if (from == to && !lost_junctions_) {
    if (!options_.drops_self_loops)
      refuse(where, "vessel " + row.id + " leads from junction " + row.from +
                        " to itself (network.drop = [\"self_loops\"] leaves such vessels out)");
    self_loops_.push_back(row.id);
    return;
  }
  const auto positive = [&](const char* what, std::optional<double> value) {
    if (!value) refuse(where, std::string(what) + " of vessel " + row.id + " is missing");
    // It is nan where a junction's coordinates could not be read, which is told there.
    if (!std::isnan(*value) && !(*value >= smallest_measure && *value <= largest_measure)) {
      refuse(where, std::string(what) + " of vessel " + row.id + " is " + text(*value) +
                        " m: must be at least " + text(smallest_measure) + " m and at most " +
                        text(largest_measure) + " m");
    }
    return *value;
  };
  const double radius = positive("radius", row.radius),
               length = positive("length", length_of(row, from, to, where)),
               wall = row.wall_thickness ? positive("wall thickness", row.wall_thickness) : 0;
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
  add_label(g.vessel_label, g.vessels(), row.name);
  g.from.push_back(from);
  g.to.push_back(to);
  g.radius.push_back(radius);
  g.length.push_back(length);
  g.wall_thickness.push_back(wall);
  g.kind.push_back(kind);
  g.generation.push_back(static_cast<std::int8_t>(generation));
  g.vessel_name.push_back(row.id);
  if (line > 0) network_.vessel_line.push_back(line);
}

void NetworkBuilder::note_ignored(const std::string& file, const std::string& what,
                                  const std::vector<std::string>& names) {
  if (names.empty()) return;
  constexpr std::size_t most = 12;
  const std::vector<std::string> told(names.begin(), names.begin() + std::min(names.size(), most));
  note(fmt::format("{}: {} that are not read: {}{}", file, what, fmt::join(told, ", "),
                   names.size() > most ? fmt::format(" and {} more", names.size() - most) : ""));
}

void NetworkBuilder::add_notes(const std::string& file) {
  const auto note_some = [&](const std::vector<std::string>& ids, const char* sentence) {
    if (!ids.empty())
      note(fmt::format("{}: {} {}; the first is {}", file, grouped(std::ssize(ids)), sentence, ids.front()));
  };
  note_some(self_loops_, "vessels that lead from a junction to itself are left out (network.drop)");
  note_some(idle_haematocrits_,
            "junctions with a haematocrit, but neither a pressure nor a flow, at which it is not used");
  if (!options_.length_unit.empty() && !uses_length_unit_)
    note(fmt::format("{}: network.file_length_unit is not used, as the file tells the unit of its lengths",
                     file));
}

BoundedGraph NetworkBuilder::finish(const std::string& file) {
  Graph& g = network_.graph;
  if (g.vessels() == 0 && faults_.count() == 0) faults_.add(file + ": there are no vessels");
  faults_.raise();
  if (!has_coordinates_.value_or(false)) g.x = g.y = g.z = {};
  if (!g.junction_label.empty()) g.junction_label.resize(g.junctions);
  if (!g.vessel_label.empty()) g.vessel_label.resize(g.vessels());
  const std::vector<std::uint32_t> degree = degrees(g);
  for (const BoundaryCondition& c : network_.conditions) {
    if (degree[c.junction] > 0) continue;
    faults_.add(file + ": junction " + g.name_of_junction(c.junction) +
                ", where a pressure or a flow is given, is no vessel's end");
  }
  faults_.raise();
  add_notes(file);
  network_.file = file;
  return std::move(network_);
}

}  // namespace rhexis::network
