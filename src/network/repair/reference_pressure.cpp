// SPDX-License-Identifier: BSD-3-Clause
#include "network/repair/reference_pressure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "core/error.hpp"
#include "core/format.hpp"
#include "network/connectivity.hpp"

namespace rhexis::network {
namespace {

constexpr double rounding = 1e-12;  ///< of flows that sum to zero as they are written, of the inflow

/// What flows at the conditions of a part, m3/s.
struct PartFlows {
  bool has_pressure = false;
  double sum = 0, inflow = 0;
  BoundaryCondition* largest_outflow = nullptr;  ///< the first of the lowest value
};

std::string flow_text(double flow) {
  return fmt::format("{}{}", flow < 0 ? "-" : "", quantity(std::abs(flow) * litres_per_minute, "L/min"));
}

/// By the first junctions of the parts.
std::map<std::uint32_t, PartFlows> flows_of_parts(BoundedGraph& network) {
  const std::vector<std::uint32_t> part = first_of_part(network.graph);
  std::map<std::uint32_t, PartFlows> parts;
  for (BoundaryCondition& condition : network.conditions) {
    PartFlows& own = parts[part[condition.junction]];
    if (condition.kind == BoundaryCondition::Kind::pressure) {
      own.has_pressure = true;
      continue;
    }
    own.sum += condition.value;
    if (condition.value > 0) own.inflow += condition.value;
    if (own.largest_outflow == nullptr || condition.value < own.largest_outflow->value)
      own.largest_outflow = &condition;
  }
  return parts;
}

}  // namespace

void set_reference_pressure(std::optional<double> pressure, BoundedGraph& network) {
  if (!pressure) return;
  const Graph& g = network.graph;
  bool used = false;
  for (const auto& [first, part] : flows_of_parts(network)) {
    if (part.has_pressure) continue;
    if (!(std::abs(part.sum) <= largest_flow_residual * part.inflow))
      throw InputError(
          fmt::format("the flows at the ends of the part of junction {} sum to {}, with {} flowing in; where "
                      "no end has a pressure they must sum to zero (to {} of the inflow)",
                      g.name_of_junction(first), flow_text(part.sum), flow_text(part.inflow),
                      largest_flow_residual),
          "network.reference_pressure");
    BoundaryCondition& reference = *part.largest_outflow;
    const std::string before = flow_text(reference.value), after = flow_text(reference.value - part.sum);
    const bool differs = before != after && std::abs(part.sum) > rounding * part.inflow;
    network.notes.push_back(fmt::format(
        "only flows are known at the ends of the part of junction {}: junction {} has network.reference_"
        "pressure, {}{}",
        g.name_of_junction(first), g.name_of_junction(reference.junction), mmhg(*pressure),
        differs ? fmt::format(", and the flow there, {}, becomes {}, so that all sum to zero", before, after)
                : std::string()));
    reference.kind = BoundaryCondition::Kind::pressure;
    reference.value = *pressure;
    used = true;
  }
  if (!used)
    network.notes.emplace_back(
        "network.reference_pressure has no effect: every part of the network has an end with a pressure");
}

}  // namespace rhexis::network
