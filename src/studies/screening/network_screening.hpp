// SPDX-License-Identifier: BSD-3-Clause
/// Screening of a whole network while its flow is found: which of its vessels are at risk.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hemodynamics/steady/flow_solver.hpp"
#include "studies/screening/screening.hpp"

namespace rhexis::screening {

/// What is found, and the vessels at highest risk, [screening.top]; on all ranks.
struct ScreenedNetwork {
  Screening screening;
  std::vector<hemodynamics::NetworkVessel> at_risk;
};

/// Given to FlowSolver::solve, it takes all vessels of the network.
class NetworkScreening final : public hemodynamics::VesselVisitor {
 public:
  /// `top`: vessels to list; `left_out`: numbers of a graph's vessels that are not screened.
  NetworkScreening(const hemodynamics::FlowProblem& problem, const Criterion& criterion, std::size_t top,
                   std::vector<std::uint32_t> left_out = {});

  const char* name() const override { return "screening"; }
  hemodynamics::VesselConsumer& consumer(int thread) override { return of_tree_->consumer(thread); }
  void visit(const network::Graph& graph, const hemodynamics::GraphFlow& flow,
             const hemodynamics::VesselMechanics& mechanics) override;

  /// After the solution by `solver`. Collective.
  ScreenedNetwork result(const hemodynamics::FlowSolver& solver, parallel::Communicator comm) const;

 private:
  Criterion criterion_;
  std::size_t top_;
  std::vector<std::uint32_t> left_out_;
  std::optional<network::TreePair> tree_;
  network::WallVariation variation_;
  std::optional<TreeScreening> of_tree_;  ///< screens a tree that streams by
  std::optional<RiskTally> of_graph_;     ///< on the rank that holds the graph
};

}  // namespace rhexis::screening
