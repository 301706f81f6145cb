// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/flow_problem.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/format.hpp"
#include "network/files/network_file.hpp"
#include "network/files/vtp_network.hpp"

namespace rhexis::hemodynamics {
namespace {

/// Generations of a tree that a machine holds in memory.
constexpr int most_generations_in_memory = 27;

void check_tier(const FlowProblem& problem) {
  const network::Parameters& n = problem.network;
  const bool is_distributed = n.tier == network::Tier::distributed_graph;
  if (n.vtp && is_distributed) throw InputError("not with network.tier = \"distributed\"", "network.vtp");
  if (n.vtp && !network::knows_vtp())
    throw InputError("VTP files need ParaView's VTK when Rhexis is built", "network.vtp");
  if (problem.blood.phase_separation && n.resolved_tier() != network::Tier::explicit_graph)
    throw InputError("phase separation needs network.tier = \"explicit\"", "blood.phase_separation");
  if (is_distributed && (!n.weakness.vessels.empty() || !n.weakness.subtrees.empty()))
    throw InputError("weak walls need network.tier = \"implicit\" or \"explicit\"", "weakness.vessels");
}

void check_files(const FlowProblem& problem) {
  const network::Parameters& n = problem.network;
  if (!n.weakness.subtrees.empty())
    throw InputError("only a tree has subtrees; name the vessels", "weakness.subtrees");
  check_key("network.files", [&] { network::format_of(n.files); });
  network::check(n.conditions);
  network::check(n.wall_ranges);
  if (n.tier == network::Tier::implicit_tree) throw InputError("only a tree can be implicit", "network.tier");
  check_key("network.file_length_unit", [&] {
    if (!n.file_length_unit.empty()) problem.to_si("1 " + n.file_length_unit, "m");
    network::check_length_unit(n, "write for example network.file_length_unit = \"mm\"");
  });
}

/// The vessels and subtrees that keys name, and whether the tree can be held as is asked for.
void check_tree(const FlowProblem& problem) {
  const network::Parameters& n = problem.network;
  for (const std::string& vessel : n.query) check_path(problem, vessel, "network.query");
  network::WallVariation(n.weakness).mark_in_tree(n.weakness, problem.tree.generations);
  check_path(problem, n.shown_subtree, "network.shown_subtree");
  if (n.tier == network::Tier::explicit_graph && problem.tree.generations > most_generations_in_memory)
    throw InputError(fmt::format("an explicit network of more than {} generations needs more memory than a "
                                 "machine has; take \"implicit\"",
                                 most_generations_in_memory),
                     "network.tier");
}

}  // namespace

void check_path(const FlowProblem& problem, const std::string& path, const char* key) {
  check_key(key, [&] { network::TreePair(problem.tree).id_of(path); });
}

std::vector<std::string> resolve(FlowProblem& problem) {
  const network::Parameters& n = problem.network;
  check(problem.blood);
  check_tier(problem);
  if (!n.is_tree()) {
    check_files(problem);
    return {};
  }
  if (!n.files.empty())
    throw InputError("files are read only where network.source = \"file\"", "network.files");
  if (!n.conditions.empty())
    throw InputError("the ends of a tree have flow.inlet_pressure, outlet_pressure and inlet_flow",
                     "condition[1].junction");
  if (!n.wall_ranges.empty())
    throw InputError("ranges are of networks from files; the walls of a tree are those of [wall]",
                     "wall_range[1].radius_from");
  problem.tree = network::rules_from(n.tree, n.wall.artery, n.wall.vein);
  const TreeBoundary boundary = tree_boundary(problem.blood);
  check_tree(problem);
  if (boundary.inlet_pressure && boundary.outlet_pressure &&
      *boundary.inlet_pressure < *boundary.outlet_pressure)
    return {
        "flow.inlet_pressure is below flow.outlet_pressure: blood runs backwards, from veins to arteries"};
  return {};
}

std::string describe_source(const FlowProblem& problem) {
  if (!problem.is_tree()) return fmt::format("{}", fmt::join(problem.network.files, ", "));
  const int generations = problem.tree.generations;
  return fmt::format("tree pair of {} generations, {} vessels in memory", generations,
                     grouped(static_cast<long long>(network::TreePair::vessels_of(generations))));
}

TreeBoundary driving_boundary(const FlowProblem& problem, const network::TreePair& tree,
                              const Hydrostatic& hydrostatic) {
  const auto weight = [&](const network::Point& p) { return hydrostatic.pressure(p[0], p[1], p[2]); };
  TreeBoundary boundary = tree_boundary(problem.blood);
  if (boundary.inlet_pressure) *boundary.inlet_pressure -= weight(tree.inlet());
  if (boundary.outlet_pressure)
    *boundary.outlet_pressure -= weight(network::TreePair::mirrored(tree.inlet()));
  return boundary;
}

VesselMechanics mechanics_of(const FlowProblem& problem) {
  const network::WallParameters& w = problem.network.wall;
  VesselMechanics m{.artery_wall = w.artery,
                    .vein_wall = w.vein,
                    .variation = network::WallVariation(problem.network.weakness),
                    .numbered_by_id = problem.is_tree(),
                    .young_modulus = w.young_modulus,
                    .poisson_ratio = w.poisson_ratio,
                    .viscosity = problem.blood.viscosity,
                    .hydrostatic = {problem.blood.density, {}}};
  std::copy(problem.blood.acceleration.begin(), problem.blood.acceleration.end(),
            m.hydrostatic.acceleration.begin());
  if (problem.is_tree()) m.variation.mark_in_tree(problem.network.weakness, problem.tree.generations);
  return m;
}

std::size_t most_shown(const FlowProblem& problem) {
  const std::int64_t usual = problem.is_tree() ? 20000 : 5000000;
  return static_cast<std::size_t>(problem.network.shown_vessels.value_or(usual));
}

}  // namespace rhexis::hemodynamics
