// SPDX-License-Identifier: BSD-3-Clause
// The flow in a network of vessels.
#include <algorithm>

#include "input/catalogue.hpp"
#include "input/units.hpp"
#include "network/network_file.hpp"
#include "network/tree_pair.hpp"
#include "network/vtp_network.hpp"
#include "scenes/scene_input.hpp"
#include "scenes/scenes.hpp"

namespace rhexis::scenes {

ParameterList declare_network(Configuration& c) {
  ParameterList all = network::declare(c.network);
  const ParameterList solver =
      hemodynamics::declare(c.hemodynamics.graph_solver);  // with its section's others
  all.insert(std::ranges::find(all, "network.statistics", &Parameter::key), solver.begin(), solver.end());
  append(all, hemodynamics::declare(c.hemodynamics));
  append(all, screening::declare(c.screening));
  return all;
}

ParameterList declare_network_scene(Configuration& c) {
  ParameterList all = declare_network(c);
  all.push_back(output::declare_format(c.output));
  append(all, insitu::declare(c.insitu));
  return all;
}

void resolve_network(Configuration& c, parallel::Communicator comm) {
  network::Parameters& n = c.network;
  hemodynamics::check(c.hemodynamics);
  if (n.vtp && n.tier == network::Tier::distributed_graph)
    throw InputError("not with network.tier = \"distributed\"", "network.vtp");
  if (n.vtp && !network::knows_vtp())
    throw InputError("VTP files need ParaView's VTK when Rhexis is built", "network.vtp");
  if (c.hemodynamics.phase_separation && n.resolved_tier() != network::Tier::explicit_graph) {
    throw InputError("phase separation needs network.tier = \"explicit\"", "blood.phase_separation");
  }
  if (n.tier == network::Tier::distributed_graph) {
    if (c.screening.top > 0)
      throw InputError("vessels are screened with network.tier = \"implicit\" or \"explicit\"",
                       "screening.top");
    if (!n.weakness.vessels.empty() || !n.weakness.subtrees.empty())
      throw InputError("weak walls need network.tier = \"implicit\" or \"explicit\"", "weakness.vessels");
  }
  if (!n.is_tree()) {
    if (!n.weakness.subtrees.empty())
      throw InputError("only a tree has subtrees; name the vessels", "weakness.subtrees");
    check_key("network.files", [&] { network::format_of(n.files); });
    if (n.tier == network::Tier::implicit_tree)
      throw InputError("only a tree can be implicit", "network.tier");
    check_key("network.file_length_unit", [&] { input::to_si("1 " + n.file_length_unit, "m"); });
    for (const input::ResolvedValue& value : c.resolved.values) {
      const bool of_trees = input::section_of(value.key) == "tree" || value.key == "flow.inlet_pressure" ||
                            value.key == "flow.outlet_pressure" || value.key == "flow.inlet_flow";
      if (of_trees && value.origin != "default")
        throw InputError("says something of a tree; of a network from files, the files say it", value.key);
    }
    warn_of_no_effect(c, "network.statistics", "on a network from files, whose vessels have no generations");
    if (network::format_of(n.files) != network::NetworkFormat::vtp)
      warn_of_no_effect(c, "network.file_length_unit", "on CSV and JSON files, which tell their units");
    find_files(n.files, "network.files", "network file", c.file, comm);
    return;
  }
  if (n.tier == network::Tier::explicit_graph || n.tier == network::Tier::distributed_graph) {
    for (const char* key : {"network.statistics", "network.shown_subtree"})
      warn_of_no_effect(
          c, key, "with network.tier = \"" + std::string(name_of(n.tier)) + "\", only with \"implicit\"");
  }
  if (!n.files.empty())
    throw InputError("files are read only where network.source = \"file\"", "network.files");
  c.tree = network::rules_from(n.tree, n.wall.artery, n.wall.vein);
  const hemodynamics::TreeBoundary boundary = hemodynamics::tree_boundary(c.hemodynamics);
  if (boundary.inlet_pressure && boundary.outlet_pressure &&
      *boundary.inlet_pressure < *boundary.outlet_pressure)
    c.warnings.push_back(
        "flow.inlet_pressure is below flow.outlet_pressure: blood runs backwards, from veins to arteries");
  if (!n.tree.length_by_radius.empty()) {
    for (const char* key : {"tree.length_ratio", "tree.length_ratio_by_generation"})
      warn_of_no_effect(c, key, "where tree.length_by_radius is given");
  }
  const network::TreePair tree(c.tree);
  const auto check_path = [&](const std::string& path, const char* key) {
    check_key(key, [&] { tree.id_of(path); });
  };
  for (const std::string& vessel : n.query) check_path(vessel, "network.query");
  network::WallVariation(n.weakness).mark_in_tree(n.weakness, c.tree.generations);
  if (c.is_coupled() && !c.coupling.screens()) check_path(c.coupling.vessel, "coupling.vessel");
  check_path(n.shown_subtree, "network.shown_subtree");
  if (n.tier == network::Tier::explicit_graph && c.tree.generations > 27) {
    throw InputError(
        "an explicit network of more than 27 generations needs more memory than a machine has; take "
        "\"implicit\"",
        "network.tier");
  }
}

}  // namespace rhexis::scenes
