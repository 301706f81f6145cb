// SPDX-License-Identifier: BSD-3-Clause
/// Networks as graphs, read or materialised, and what the solvers that hold one have in common.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "hemodynamics/hydrostatic.hpp"
#include "hemodynamics/steady/flow_solver.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "network/graph.hpp"

namespace rhexis::hemodynamics {

/// Graph and conditions, read or materialised; the weight of blood is taken off the conditions' pressures.
/// Throws InputError.
network::BoundedGraph make_graph_network(const FlowProblem& problem, const Hydrostatic& hydrostatic);

/// Adds the weight of blood to the pressures [J] of the solver.
void add_weight(const network::Graph& graph, const Hydrostatic& hydrostatic, std::vector<double>& pressure);

/// Conductance of every vessel by Eq. (9), [V], m3/(s Pa); `haematocrit` [V], or empty: that of the inflowing
/// blood.
std::vector<double> conductances(const network::Graph& graph, const Viscosity& viscosity,
                                 std::span<const double> haematocrit);

/// The vessel of a name in a file, of an id or path in a tree. Throws InputError, of `key`, where there is
/// none.
std::uint32_t find_vessel(const FlowProblem& problem, const network::Graph& graph, const std::string& name,
                          const std::string& key);

/// At most `count` vessels, the widest, in ascending order of their numbers.
std::vector<std::uint32_t> widest_vessels(const network::Graph& graph, std::size_t count);

/// Volume (m3) and wall surface (m2) of all lumens.
std::array<double, 2> lumen_of(const network::Graph& graph);

/// The Reynolds number of the fastest vessel; `haematocrit` as for conductances.
double highest_reynolds_number(const network::Graph& graph, const GraphFlow& flow,
                               const VesselMechanics& mechanics, std::span<const double> haematocrit);

/// The lowest and the highest of pressures that are not nan.
std::array<double, 2> extremes_of(const std::vector<double>& pressure);

/// All of one vessel but its name.
NetworkVessel describe_vessel(const network::Graph& graph, const GraphFlow& flow, std::uint32_t vessel,
                              const VesselMechanics& mechanics);

inline constexpr const char* no_coordinates = "the junctions have no coordinates: no lines to store and draw";

}  // namespace rhexis::hemodynamics
