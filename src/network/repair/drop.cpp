// SPDX-License-Identifier: BSD-3-Clause
#include "network/repair/drop.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/format.hpp"
#include "network/connectivity.hpp"

namespace rhexis::network {
namespace {

/// The elements of `values`, one an item, or none at all, with `kept`.
template <class T>
void keep(std::vector<T>& values, const std::vector<bool>& kept) {
  if (values.empty()) return;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i] && count++ != i) values[count - 1] = std::move(values[i]);
  values.resize(count);
}

/// Names that are the numbers of items, before these change.
void name_by_number(std::vector<std::string>& names, std::size_t count) {
  if (!names.empty()) return;
  for (std::size_t i = 0; i < count; ++i) names.push_back(std::to_string(i));
}

/// Keeps what has `kept`, and notes the rest as `what`.
void drop(BoundedGraph& network, const std::vector<bool>& kept, const std::string& what) {
  const auto first = std::ranges::find(kept, false);
  if (first == kept.end()) return;
  network.notes.push_back(fmt::format(
      "{} {} are left out (network.drop); the first is {}", grouped(std::ranges::count(kept, false)), what,
      network.graph.name_of_vessel(static_cast<std::size_t>(first - kept.begin()))));
  keep_vessels(network, kept);
}

}  // namespace

void keep_vessels(BoundedGraph& network, const std::vector<bool>& kept) {
  Graph& g = network.graph;
  name_by_number(g.vessel_name, g.vessels());
  name_by_number(g.junction_name, g.junctions);
  std::vector<bool> kept_junctions(g.junctions);
  for (std::size_t v = 0; v < g.vessels(); ++v)
    if (kept[v]) kept_junctions[g.from[v]] = kept_junctions[g.to[v]] = true;
  std::vector<std::uint32_t> number(g.junctions);
  std::uint32_t next = 0;
  for (std::size_t j = 0; j < g.junctions; ++j) number[j] = kept_junctions[j] ? next++ : next;
  std::erase_if(network.conditions, [&](const BoundaryCondition& c) { return !kept_junctions[c.junction]; });
  for (BoundaryCondition& condition : network.conditions) condition.junction = number[condition.junction];
  for (auto* ends : {&g.from, &g.to}) {
    keep(*ends, kept);
    for (std::uint32_t& j : *ends) j = number[j];
  }
  for (auto* measures : {&g.radius, &g.length, &g.wall_thickness}) keep(*measures, kept);
  if (!g.first_piece.empty()) {
    Graph left;
    for (std::size_t v = 0; v < kept.size(); ++v)
      if (kept[v]) left.add_pieces(g.pieces(v));
    g.first_piece = std::move(left.first_piece);
    g.piece = std::move(left.piece);
  }
  keep(g.kind, kept);
  keep(g.generation, kept);
  keep(g.vessel_name, kept);
  keep(g.vessel_label, kept);
  keep(network.vessel_line, kept);
  for (auto* coordinates : {&g.x, &g.y, &g.z}) keep(*coordinates, kept_junctions);
  keep(g.junction_name, kept_junctions);
  keep(g.junction_label, kept_junctions);
  g.junctions = next;
}

void drop_islands(BoundedGraph& network) {
  const Graph& g = network.graph;
  const std::vector<std::uint32_t> part = first_of_part(g);
  std::vector<bool> has_condition(g.junctions);
  for (const BoundaryCondition& condition : network.conditions)
    has_condition[part[condition.junction]] = true;
  std::vector<bool> kept(g.vessels());
  for (std::size_t v = 0; v < g.vessels(); ++v) kept[v] = has_condition[part[g.from[v]]];
  if (std::ranges::find(kept, true) != kept.end())
    drop(network, kept, "vessels of parts without any pressure or flow");
}

void drop_dead_ends(BoundedGraph& network) {
  const Graph& g = network.graph;
  // The exclusive or of a junction's vessels is, once all but one are gone, the one that is left.
  std::vector<std::uint32_t> degree = degrees(g), vessels(g.junctions);
  for (std::uint32_t v = 0; v < g.vessels(); ++v)
    for (const std::uint32_t j : {g.from[v], g.to[v]}) vessels[j] ^= v;
  std::vector<bool> has_condition(g.junctions), kept(g.vessels(), true);
  for (const BoundaryCondition& condition : network.conditions) has_condition[condition.junction] = true;
  for (std::uint32_t start = 0; start < g.junctions; ++start) {
    for (std::uint32_t j = start; degree[j] == 1 && !has_condition[j];) {
      const std::uint32_t v = vessels[j], other = g.from[v] == j ? g.to[v] : g.from[v];
      kept[v] = false;
      degree[j] = 0;
      --degree[other];
      vessels[other] ^= v;
      j = other;
    }
  }
  if (std::ranges::find(kept, true) == kept.end())
    throw InputError("\"dead_ends\" leaves no vessel: no two ends have a pressure or a flow", "network.drop");
  drop(network, kept, "vessels that lead only to ends without a pressure or flow");
}

}  // namespace rhexis::network
