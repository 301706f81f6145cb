// SPDX-License-Identifier: BSD-3-Clause
/// Haematocrit, viscosity and flow of an explicit network, each depending on the others, by iteration to a
/// fixed point.
///
/// One round: conductances of the haematocrits (Eq. 9), flow; then, from high pressure to low, what enters a
/// junction is mixed and passed on: at a bifurcation by phase separation (phase_separation.hpp), elsewhere in
/// proportion to flow. The step of a vessel towards its new haematocrit is halved while that oscillates: with
/// phase separation the plain iteration may oscillate. A vessel never passes on more cells than its outlet
/// carries: haematocrits stay below 0.99, and what a branch cannot take goes to the other.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "network/graph.hpp"

namespace rhexis::hemodynamics {

struct HaematocritOptions {
  double inflow_haematocrit = 0.45;   ///< discharge haematocrit of blood that enters, where no other is given
  std::vector<double> entering = {};  ///< [J] the same of each junction; empty: inflow_haematocrit everywhere
  double tolerance = 1e-8;            ///< largest change of a vessel's haematocrit in a full step
  std::int64_t max_iterations = 200;
};

struct HaematocritFlow {
  GraphFlow flow;
  std::vector<double> haematocrit;  ///< [V] discharge haematocrit; of a vessel without flow the inflow's
  std::int64_t iterations = 0;
  double change = 0;       ///< last one, the largest of all vessels
  double mean_change = 0;  ///< last one, the mean over all vessels weighted by their flows
  bool converged = false;
};

/// Flow for the haematocrits [V] of all vessels.
using FlowOfHaematocrit = std::function<GraphFlow(std::span<const double> haematocrit)>;

/// [J] discharge haematocrit of blood that enters at each junction: that of its condition, else `usual`.
/// Empty where no condition has one.
std::vector<double> entering_haematocrit(const network::BoundedGraph& network, double usual);

/// Haematocrits [V] that a given flow carries through the network.
std::vector<double> carried_haematocrit(const network::Graph& graph, const GraphFlow& flow,
                                        double inflow_haematocrit, std::span<const double> entering = {});

HaematocritFlow find_haematocrit(const network::Graph& graph, const FlowOfHaematocrit& solve,
                                 const HaematocritOptions& options);

}  // namespace rhexis::hemodynamics
