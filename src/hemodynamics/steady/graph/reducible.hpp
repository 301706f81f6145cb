// SPDX-License-Identifier: BSD-3-Clause
/// The way from a graph and its boundary into a Reduction, and what is said of the flows that come out of it:
/// for one rank and for several.
#pragma once

#include <vector>

#include "hemodynamics/steady/graph/boundary.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "hemodynamics/steady/graph/reduction.hpp"
#include "parallel/shared_values.hpp"

namespace rhexis::hemodynamics {

/// The graph with its ghosts. Junctions in `also_kept` stay, besides those of fixed pressure.
Reduction reducible(const network::Graph& graph, std::vector<double> conductance, const Boundary& boundary,
                    const std::vector<std::uint32_t>& also_kept);

/// Junctions of fixed pressure, then ghosts.
std::vector<Boundary::Fixed> all_fixed(const network::Graph& graph, const Boundary& boundary);

double sum_of_inflows(const Boundary& boundary);

/// Fills in inflow and imbalance of the flows as they are, and forgets the ghosts. The imbalance is relative
/// to the inflow, or to `smallest_inflow` where that is larger. Collective where `shared` is given: then a
/// condition of flow and a ghost are in the boundary of one rank only.
void judge(const network::Graph& graph, const Boundary& boundary, double smallest_inflow,
           parallel::SharedValues* shared, GraphFlow& result);

/// nan where nothing is `connected`, unless a condition says more; fixed pressures to the digit.
void set_pressures_of_conditions(const Boundary& boundary, const std::vector<bool>& connected,
                                 std::vector<double>& pressure);

}  // namespace rhexis::hemodynamics
