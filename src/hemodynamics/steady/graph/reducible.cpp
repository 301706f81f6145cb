// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/reducible.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "parallel/large_array.hpp"

namespace rhexis::hemodynamics {

Reduction reducible(const network::Graph& graph, std::vector<double> conductance, const Boundary& boundary,
                    const std::vector<std::uint32_t>& also_kept) {
  const std::size_t junctions = graph.junctions + boundary.ghosts.size();
  const std::size_t vessels = graph.vessels() + boundary.ghosts.size();
  std::vector<std::uint32_t> tail, head;
  parallel::reserve_large(tail, vessels);
  parallel::reserve_large(head, vessels);
  conductance.reserve(vessels);
  tail.assign(graph.from.begin(), graph.from.end());
  head.assign(graph.to.begin(), graph.to.end());
  auto injection = parallel::large_array<double>(junctions);
  std::vector<bool> kept(junctions);
  for (std::size_t n = 0; n < boundary.ghosts.size(); ++n) {
    tail.push_back(boundary.ghosts[n].junction);
    head.push_back(static_cast<std::uint32_t>(graph.junctions + n));
    conductance.push_back(boundary.ghosts[n].conductance);
    kept[graph.junctions + n] = true;
  }
  for (const auto& fixed : boundary.fixed) kept[fixed.junction] = true;
  for (const std::uint32_t j : also_kept) kept[j] = true;
  for (const auto& inflow : boundary.inflows) injection[inflow.junction] = inflow.flow;
  return {std::move(tail), std::move(head), std::move(conductance), std::move(injection), std::move(kept)};
}

std::vector<Boundary::Fixed> all_fixed(const network::Graph& graph, const Boundary& boundary) {
  std::vector<Boundary::Fixed> fixed = boundary.fixed;
  for (std::size_t n = 0; n < boundary.ghosts.size(); ++n) {
    fixed.push_back({static_cast<std::uint32_t>(graph.junctions + n), boundary.ghosts[n].pressure});
  }
  return fixed;
}

double sum_of_inflows(const Boundary& boundary) {
  double sum = 0;
  for (const auto& inflow : boundary.inflows) sum += std::max(inflow.flow, 0.0);
  return sum;
}

void judge(const network::Graph& graph, const Boundary& boundary, double smallest_inflow,
           parallel::SharedValues* shared, GraphFlow& result) {
  auto outflow = parallel::large_array<double>(
      graph.junctions);  // through vessels and ghosts, less what a condition injects
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    outflow[graph.from[v]] += result.flow[v];
    outflow[graph.to[v]] -= result.flow[v];
  }
  result.inflow = sum_of_inflows(boundary);
  for (std::size_t n = 0; n < boundary.ghosts.size(); ++n) {
    const double out = result.flow[graph.vessels() + n];
    outflow[boundary.ghosts[n].junction] += out;
    result.inflow += std::max(-out, 0.0);
  }
  for (const auto& inflow : boundary.inflows) outflow[inflow.junction] -= inflow.flow;
  if (shared != nullptr) {
    shared->add_to_owner(outflow);
    for (const auto& link : shared->links()) {
      for (const std::uint32_t j : link.borrowed) outflow[j] = 0;
    }
  }
  for (const auto& fixed : boundary.fixed) {
    result.inflow += std::max(outflow[fixed.junction], 0.0);
    outflow[fixed.junction] = 0;
  }
  double worst = 0;
  for (const double out : outflow) worst = std::max(worst, std::abs(out));
  if (shared != nullptr) {
    result.inflow = shared->communicator().all_reduce(result.inflow, parallel::Reduce::sum);
    worst = shared->communicator().all_reduce(worst, parallel::Reduce::max);
  }
  const double scale = std::max(result.inflow, smallest_inflow);
  result.max_imbalance = worst == 0 ? 0 : worst / scale;
  result.flow.resize(graph.vessels());
  result.pressure.resize(graph.junctions);
}

void set_pressures_of_conditions(const Boundary& boundary, const std::vector<bool>& connected,
                                 std::vector<double>& pressure) {
  for (std::size_t j = 0; j < pressure.size(); ++j) {
    if (!connected[j]) pressure[j] = std::numeric_limits<double>::quiet_NaN();
  }
  for (const auto& fixed : boundary.fixed) pressure[fixed.junction] = fixed.pressure;
  for (const auto& ghost : boundary.ghosts) {
    if (!connected[ghost.junction]) pressure[ghost.junction] = ghost.pressure;
  }
}

}  // namespace rhexis::hemodynamics
