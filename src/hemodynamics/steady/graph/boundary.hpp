// SPDX-License-Identifier: BSD-3-Clause
/// What is known at the rim of a network, checked and sorted by what the solver does with it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "network/graph.hpp"

namespace rhexis::hemodynamics {

/// Throws InputError, naming the vessel, where one ends outside of the graph, joins a junction to itself, or
/// has a conductance that is not positive and finite.
void check_vessels(const network::Graph& graph, std::span<const double> conductance);

/// Conditions by kind. A pressure behind a resistance becomes a vessel to a junction of its own ('ghost')
/// that has that pressure: ghost n is junction J + n.
struct Boundary {
  struct Fixed {
    std::uint32_t junction;
    double pressure;
  };
  struct Ghost {
    std::uint32_t junction;  ///< number in the graph
    double pressure, conductance;
  };
  struct Inflow {
    std::uint32_t junction;
    double flow;
  };
  std::vector<Fixed> fixed;
  std::vector<Ghost> ghosts;
  std::vector<Inflow> inflows;
};

using NameOfJunction = std::function<std::string(std::size_t)>;

/// Throws InputError, naming the junction, where conditions contradict each other or mean nothing.
Boundary sort_conditions(const network::Graph& graph, std::span<const network::BoundaryCondition> conditions,
                         const NameOfJunction& name);

/// [J] whether a junction is the end of a vessel.
std::vector<bool> junctions_with_vessels(const network::Graph& graph);

/// The first junction of the component of `junction`, by name.
std::string name_of_first(const network::Graph& graph, std::uint32_t junction);

/// Throw InputError: a part of the network without any condition of pressure, `junction` is in it; an inflow
/// that cannot go anywhere.
[[noreturn]] void throw_floating(const std::string& junction);
[[noreturn]] void throw_inflow_without_vessels(const std::string& junction);

}  // namespace rhexis::hemodynamics
