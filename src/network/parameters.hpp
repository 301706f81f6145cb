// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of the sections network, condition, tree, wall, wall_range and weakness.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "network/lines/line_network.hpp"
#include "network/repair/end_conditions.hpp"
#include "network/repair/wall_ranges.hpp"
#include "network/tree/tree_rules.hpp"
#include "network/wall.hpp"
#include "network/wall_variation.hpp"

namespace rhexis::network {

struct WallParameters {
  Wall artery{.rule = WallRule::ratio, .ratio = 1.0 / 3}, vein{.rule = WallRule::ratio, .ratio = 0.1};
  double young_modulus = 3.5e6;  ///< Pa
  double poisson_ratio = 0.25;
};

/// Where the vessels come from.
enum class Source { tree, file };

constexpr auto name_table(Source) {
  using enum Source;
  return std::to_array<Named<Source>>({{tree, "tree"}, {file, "file"}});
}

/// How a network is held: nothing of a tree is stored; all vessels in memory; over all ranks' memory.
enum class Tier { automatic, implicit_tree, explicit_graph, distributed_graph };

constexpr auto name_table(Tier) {
  using enum Tier;
  return std::to_array<Named<Tier>>({{automatic, "auto"},
                                     {implicit_tree, "implicit"},
                                     {explicit_graph, "explicit"},
                                     {distributed_graph, "distributed"}});
}

struct Parameters {
  Source source = Source::tree;
  std::vector<std::string> files;
  std::string file_length_unit;                      ///< of files that do not tell theirs; empty: not given
  double merge_tolerance = default_merge_tolerance;  ///< fraction of the radius
  std::vector<std::string> drop;                     ///< "self_loops", "islands", "dead_ends"
  std::vector<EndCondition> conditions;
  std::optional<double> reference_pressure;  ///< Pa, of parts where only flows are known
  Tier tier = Tier::automatic;
  bool statistics = true;
  std::vector<std::string> query;
  std::optional<std::int64_t> shown_vessels;
  std::string shown_subtree = "artery.";
  bool vtp = false;
  TreeParameters tree;
  WallParameters wall;
  std::vector<WallRange> wall_ranges;
  WeaknessParameters weakness;

  bool is_tree() const { return source == Source::tree; }
  /// How the network is held, once `automatic` is resolved: implicit for a tree, explicit for files.
  Tier resolved_tier() const;
};

/// The keys, bound to `p`.
ParameterList declare(Parameters& p);

}  // namespace rhexis::network
