// SPDX-License-Identifier: BSD-3-Clause
/// The steady flow in a graph some of whose vessels have ruptured: they bleed, or nothing flows through them
/// any more.
#pragma once

#include <cstdint>
#include <vector>

#include "hemodynamics/steady/bleeding.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "network/graph.hpp"

namespace rhexis::hemodynamics {

/// A vessel that has ruptured, as its network sees it.
struct VesselFailure {
  std::uint32_t vessel = 0;  ///< its number in the graph
  bool occluded = false;     ///< nothing flows through it any more
  Orifice orifice = {};      ///< lies half way along the vessel; unused where that is occluded
};

class RupturedNetwork {
 public:
  /// Bleeding vessels are cut in two halves that meet at a new junction, after all others.
  /// `conductance` [V], m3/(s Pa).
  RupturedNetwork(network::Graph graph, std::vector<double> conductance,
                  std::vector<network::BoundaryCondition> conditions, std::vector<VesselFailure> failures);

  struct Result {
    GraphFlow flow;             ///< of the first J junctions and V vessels, those of the intact graph; a
                                ///< bleeding vessel's flow is that at its `from` end
    std::vector<double> leaks;  ///< m3/s, of every failure
  };
  /// Leaks obey the orifice law; they are solved as resistances that are adjusted until they do, which halves
  /// the error at least in each round. Throws RunError as solve_flow does, and where `rounds` do not suffice.
  Result solve(const GraphSolverOptions& options, int rounds = 60);

  /// With the leaks of the last solution as constant resistances.
  const network::Graph& graph() const { return graph_; }
  const std::vector<double>& conductance() const { return conductance_; }
  const std::vector<network::BoundaryCondition>& conditions() const { return conditions_; }

 private:
  std::size_t junctions_, vessels_;  ///< counts of the intact graph
  network::Graph graph_;
  std::vector<double> conductance_;
  std::vector<network::BoundaryCondition> conditions_;
  std::vector<VesselFailure> failures_;
  std::vector<std::size_t> condition_of_;  ///< [failures]; none: it does not leak
};

}  // namespace rhexis::hemodynamics
