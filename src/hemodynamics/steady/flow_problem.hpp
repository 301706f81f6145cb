// SPDX-License-Identifier: BSD-3-Clause
/// The steady flow that is asked for: a network, its blood, and what is to be kept of the solution.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/csv_table.hpp"
#include "hemodynamics/parameters.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "hemodynamics/steady/ruptured_network.hpp"
#include "hemodynamics/vessel_lines.hpp"
#include "network/parameters.hpp"
#include "network/tree/tree_pair.hpp"

namespace rhexis::hemodynamics {

struct FlowProblem {
  network::Parameters network = {};
  network::TreeRules tree = {};  ///< where network.source = "tree"
  Parameters blood = {};
  ToSi to_si = {};                           ///< reads the units of a network's files
  std::vector<VesselFailure> failures = {};  ///< vessels of a graph that have ruptured before
  bool is_tree() const { return network.is_tree(); }
  /// Whether a tree is held in memory as a graph.
  bool builds_tree() const { return is_tree() && network.resolved_tier() != network::Tier::implicit_tree; }
};

/// Checks what one key alone cannot tell, and makes the rules of a tree. Throws InputError with the key at
/// fault. Returns warnings.
std::vector<std::string> resolve(FlowProblem& problem);

/// Throws InputError with `key` where no vessel of the tree has the `path`, such as "artery.0110".
void check_path(const FlowProblem& problem, const std::string& path, const char* key);

/// "tree pair of 20 generations, 2,097,150 vessels in memory", or the names of the files.
std::string describe_source(const FlowProblem& problem);

/// What drives the flow of a tree: its boundary with pressures less the weight of blood at their places.
TreeBoundary driving_boundary(const FlowProblem& problem, const network::TreePair& tree,
                              const Hydrostatic& hydrostatic);

/// What turns pressures into strains. Weak walls of a tree are marked; of a network from files, the solver
/// that reads them does that.
VesselMechanics mechanics_of(const FlowProblem& problem);

/// Vessels to store and draw at most.
std::size_t most_shown(const FlowProblem& problem);

}  // namespace rhexis::hemodynamics
