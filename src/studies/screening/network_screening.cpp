// SPDX-License-Identifier: BSD-3-Clause
#include "studies/screening/network_screening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rhexis::screening {

NetworkScreening::NetworkScreening(const hemodynamics::FlowProblem& problem, const Criterion& criterion,
                                   std::size_t top, std::vector<std::uint32_t> left_out)
    : criterion_(criterion), top_(top), left_out_(std::move(left_out)) {
  if (!problem.is_tree() || problem.builds_tree()) return;
  tree_.emplace(problem.tree);
  variation_ = mechanics_of(problem).variation;
  of_tree_.emplace(*tree_, variation_, criterion_, top_);
}

void NetworkScreening::visit(const network::Graph& g, const hemodynamics::GraphFlow& flow,
                             const hemodynamics::VesselMechanics& mechanics) {
  const int generations =
      g.generation.empty() ? 0 : 1 + *std::max_element(g.generation.begin(), g.generation.end());
  of_graph_.emplace(generations, top_);
  std::vector<bool> left_out(g.vessels());
  for (const std::uint32_t v : left_out_) left_out[v] = true;
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    if (left_out[v]) continue;
    const double pressure = 0.5 * (flow.pressure[g.from[v]] + flow.pressure[g.to[v]]);
    if (std::isnan(pressure)) continue;  // no blood reaches it
    const network::WallFactors strength{wall_factors(g, v, mechanics).strength, 1};
    double thickness = std::numeric_limits<double>::infinity();  // relative, where it is least
    g.for_each_piece(v, [&](double radius, double) {
      thickness = std::min(thickness, wall_thickness_at(g, v, radius, mechanics) / radius);
    });
    of_graph_->add(g.generation.empty() ? -1 : g.generation[v],
                   g.kind.empty() ? network::VesselKind::unknown : g.kind[v],
                   {risk(criterion_, pressure, thickness, strength), v, 1});
  }
}

ScreenedNetwork NetworkScreening::result(const hemodynamics::FlowSolver& solver,
                                         parallel::Communicator comm) const {
  ScreenedNetwork found;
  if (of_tree_) {
    found.screening = of_tree_->result(comm);
  } else {
    const std::int64_t generations =
        comm.all_reduce(std::int64_t{of_graph_ ? of_graph_->generations() : 0}, parallel::Reduce::max);
    found.screening = (of_graph_ ? *of_graph_ : RiskTally(static_cast<int>(generations), top_)).result(comm);
  }
  for (const RankedVessel& v : found.screening.top)
    found.at_risk.push_back(solver.vessel(static_cast<std::int64_t>(v.vessel)));
  return found;
}

}  // namespace rhexis::screening
