// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/network/network_input.hpp"

#include <algorithm>

#include "input/catalogue.hpp"
#include "runtime/version.hpp"

namespace rhexis::scenes {
namespace {

/// Keys of a tree, and the two ends of its flow, in the input of a network from files.
void refuse_keys_of_trees(const SceneInput& s) {
  for (const input::ResolvedValue& value : s.resolved.values) {
    const bool of_trees = input::section_of(value.key) == "tree" || value.key == "flow.inlet_pressure" ||
                          value.key == "flow.outlet_pressure" || value.key == "flow.inlet_flow";
    if (of_trees && value.origin != "default")
      throw InputError("says something of a tree; of a network from files, the files say it", value.key);
  }
}

void warn_of_keys_without_effect(SceneInput& s, const network::Parameters& n) {
  if (!n.is_tree()) {
    warn_of_no_effect(s, "network.statistics", "on a network from files, whose vessels have no generations");
    return;
  }
  if (n.resolved_tier() != network::Tier::implicit_tree) {
    for (const char* key : {"network.statistics", "network.shown_subtree"})
      warn_of_no_effect(
          s, key, "with network.tier = \"" + std::string(name_of(n.tier)) + "\", only with \"implicit\"");
  }
  if (!n.tree.length_by_radius.empty()) {
    for (const char* key : {"tree.length_ratio", "tree.length_ratio_by_generation"})
      warn_of_no_effect(s, key, "where tree.length_by_radius is given");
  }
}

}  // namespace

ParameterList declare_network(NetworkInput& n) {
  ParameterList all = network::declare(n.problem.network);
  const ParameterList solver =
      hemodynamics::declare(n.problem.blood.graph_solver);  // with its section's others
  all.insert(std::ranges::find(all, "network.statistics", &Parameter::key), solver.begin(), solver.end());
  append(all, hemodynamics::declare(n.problem.blood));
  append(all, screening::declare(n.screening));
  return all;
}

void resolve_network(SceneInput& s, NetworkInput& n, parallel::Communicator comm) {
  if (n.problem.network.tier == network::Tier::distributed_graph && n.screening.top > 0)
    throw InputError("vessels are screened with network.tier = \"implicit\" or \"explicit\"",
                     "screening.top");
  const std::vector<std::string> warnings = hemodynamics::resolve(n.problem);
  if (!n.problem.is_tree()) refuse_keys_of_trees(s);
  warn_of_keys_without_effect(s, n.problem.network);
  append(s.warnings, warnings);
  if (!n.problem.is_tree())
    find_files(n.problem.network.files, "network.files", "network file", s.file, comm);
}

studies::ScreeningPlan screening_plan(const NetworkInput& n, double outside_pressure,
                                      std::vector<std::uint32_t> left_out) {
  const network::WallParameters& wall = n.problem.network.wall;
  return {
      .criterion = {n.screening.critical_stretch, wall.young_modulus, wall.poisson_ratio, outside_pressure},
      .top = static_cast<std::size_t>(n.screening.top),
      .left_out = std::move(left_out)};
}

studies::NetworkFilesPlan network_files_plan(const SceneInput& s, const NetworkInput& n,
                                             const output::Parameters& output) {
  return {s.title, runtime::version(), output::formats_of(output), n.problem.network.vtp};
}

}  // namespace rhexis::scenes
