// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/ruptured_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace rhexis::hemodynamics {
namespace {

using network::BoundaryCondition;

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
/// An occluded vessel keeps this share of its conductance, so that the graph stays connected.
constexpr double left_of_conductance = 1e-12;
/// The rounds end when no resistance of a leak changes by more, relative to itself.
constexpr double tolerance = 1e-10;
/// Larger changes after the last round are an error; between the two lies the noise of iterative solvers.
constexpr double largest_last_change = 1e-6;
/// Resistance of a leak to begin with, times its strength, Pa^1/2: as if the pressure of a body drove it.
constexpr double usual_root = 100;
/// The same where nothing drives it.
constexpr double closed_root = 1e11;

}  // namespace

RupturedNetwork::RupturedNetwork(network::Graph graph, std::vector<double> conductance,
                                 std::vector<BoundaryCondition> conditions,
                                 std::vector<VesselFailure> failures)
    : junctions_(graph.junctions),
      vessels_(graph.vessels()),
      graph_(std::move(graph)),
      conductance_(std::move(conductance)),
      conditions_(std::move(conditions)),
      failures_(std::move(failures)) {
  graph_.junction_name.clear();
  graph_.vessel_name.clear();
  for (const VesselFailure& failure : failures_) {
    condition_of_.push_back(none);
    if (failure.occluded || failure.orifice.strength <= 0) {
      if (failure.occluded) conductance_[failure.vessel] *= left_of_conductance;
      continue;
    }
    const auto middle = static_cast<std::uint32_t>(graph_.junctions++);
    graph_.from.push_back(middle);
    graph_.to.push_back(graph_.to[failure.vessel]);
    graph_.to[failure.vessel] = middle;
    conductance_[failure.vessel] *= 2;
    conductance_.push_back(conductance_[failure.vessel]);
    condition_of_.back() = conditions_.size();
    conditions_.push_back({middle, BoundaryCondition::Kind::pressure, failure.orifice.outside_pressure,
                           usual_root / failure.orifice.strength});
  }
}

RupturedNetwork::Result RupturedNetwork::solve(const GraphSolverOptions& options, int rounds) {
  Result result;
  result.leaks.assign(failures_.size(), 0.0);
  double change = 1;
  for (int round = 0; round < rounds && change > tolerance; ++round) {
    result.flow = solve_flow(graph_, conductance_, conditions_, options);
    change = 0;
    for (std::size_t i = 0; i < failures_.size(); ++i) {
      if (condition_of_[i] == none) continue;
      BoundaryCondition& leak = conditions_[condition_of_[i]];
      const double drive = result.flow.pressure[leak.junction] - leak.value;
      result.leaks[i] = drive / leak.resistance;
      const double resistance = (drive > 0 ? std::sqrt(drive) : closed_root) / failures_[i].orifice.strength;
      change = std::max(change, std::abs(resistance / leak.resistance - 1));
      leak.resistance = resistance;
    }
  }
  if (change > largest_last_change) {
    throw RunError(fmt::format(
        "the leaks of the ruptured vessels still change by {:.1e} of themselves after {} rounds of the "
        "network's solution",
        change, rounds));
  }
  result.flow.pressure.resize(junctions_);
  result.flow.flow.resize(vessels_);
  return result;
}

}  // namespace rhexis::hemodynamics
