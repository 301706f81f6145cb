// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/boundary.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"
#include "network/connectivity.hpp"

namespace rhexis::hemodynamics {

void check_vessels(const network::Graph& graph, std::span<const double> conductance) {
  // Signs of conductances and one bit of vessel numbers are used by Reduction.
  if (graph.vessels() >= 0x7fffffff || graph.junctions >= 0x7fffffff) {
    throw InputError("the network has more than 2^31 vessels or junctions: use more ranks");
  }
  if (graph.to.size() != graph.vessels() || conductance.size() != graph.vessels()) {
    throw InputError("the network has " + std::to_string(graph.vessels()) + " vessels, but " +
                     std::to_string(graph.to.size()) + " ends and " + std::to_string(conductance.size()) +
                     " conductances");
  }
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    const std::uint32_t from = graph.from[v], to = graph.to[v];
    if (from >= graph.junctions || to >= graph.junctions) {
      throw InputError("vessel " + graph.name_of_vessel(v) +
                       " ends at a junction that does not exist: there are " +
                       std::to_string(graph.junctions));
    }
    if (from == to) {
      throw InputError("vessel " + graph.name_of_vessel(v) + " joins junction " +
                       graph.name_of_junction(from) + " to itself");
    }
    if (!(conductance[v] > 0) || !std::isfinite(conductance[v])) {
      throw InputError("vessel " + graph.name_of_vessel(v) + " has conductance " + text(conductance[v]) +
                       " m3/(s Pa); it must be positive and finite: check its radius and length");
    }
  }
}

Boundary sort_conditions(const network::Graph& graph, std::span<const network::BoundaryCondition> conditions,
                         const NameOfJunction& name_of) {
  Boundary boundary;
  std::vector<bool> conditioned(graph.junctions);
  for (const network::BoundaryCondition& condition : conditions) {
    const std::uint32_t j = condition.junction;
    if (j >= graph.junctions) {
      throw InputError("a condition is set at junction " + std::to_string(j) +
                       ", which does not exist: there are " + std::to_string(graph.junctions));
    }
    const std::string name = "junction " + name_of(j);
    if (conditioned[j]) throw InputError(name + " has two conditions; give one");
    conditioned[j] = true;
    if (!std::isfinite(condition.value))
      throw InputError(name + " has a condition that is not a finite number");
    if (condition.kind == network::BoundaryCondition::Kind::flow) {
      if (condition.resistance != 0)
        throw InputError(name + " has a flow with a resistance; only a pressure may have one");
      boundary.inflows.push_back({j, condition.value});
    } else if (condition.resistance == 0) {
      boundary.fixed.push_back({j, condition.value});
    } else {
      const double conductance = 1 / condition.resistance;
      if (!(conductance > 0) || !std::isfinite(conductance)) {
        throw InputError(name + " has resistance " + text(condition.resistance) +
                         " Pa s/m3; it must be zero, or positive and finite");
      }
      boundary.ghosts.push_back({j, condition.value, conductance});
    }
  }
  return boundary;
}

std::vector<bool> junctions_with_vessels(const network::Graph& graph) {
  const std::vector<std::uint32_t> degree = network::degrees(graph);
  std::vector<bool> connected(graph.junctions);
  for (std::size_t j = 0; j < connected.size(); ++j) connected[j] = degree[j] > 0;
  return connected;
}

std::string name_of_first(const network::Graph& graph, std::uint32_t junction) {
  return graph.name_of_junction(network::first_of_part(graph)[junction]);
}

void throw_floating(const std::string& junction) {
  throw InputError(
      "nothing sets the pressure in the part of the network that junction " + junction +
      " belongs to: give one of its junctions a condition of pressure, in the file or by [[condition]] "
      "(network.drop = [\"islands\"] leaves out parts without any condition; network.reference_pressure "
      "serves those where flows are known)");
}

void throw_inflow_without_vessels(const std::string& junction) {
  throw InputError("junction " + junction + " has an inflow but no vessels");
}

}  // namespace rhexis::hemodynamics
