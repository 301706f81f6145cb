#include "coupling/injured_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rhexis::coupling {
namespace {

using network::Condition;

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
/// Of an occluded vessel: the graph stays connected.
constexpr double left_of_conductance = 1e-12;
constexpr int most_rounds = 60;
constexpr double tolerance = 1e-10;
/// Resistance of a leak to begin with, times its strength, Pa^1/2: as if the pressure of a body drove it.
constexpr double usual_root = 100;
/// The same where nothing drives it.
constexpr double closed_root = 1e11;

}  // namespace

InjuredGraph::InjuredGraph(network::Graph graph, std::vector<double> conductance,
                           std::vector<Condition> conditions, std::vector<Injury> injuries)
    : junctions_(graph.junctions),
      vessels_(graph.vessels()),
      graph_(std::move(graph)),
      conductance_(std::move(conductance)),
      conditions_(std::move(conditions)),
      injuries_(std::move(injuries)) {
  graph_.junction_name.clear();
  graph_.vessel_name.clear();
  for (const Injury& injury : injuries_) {
    condition_of_.push_back(none);
    if (injury.occluded || injury.orifice.strength <= 0) {
      if (injury.occluded) conductance_[injury.vessel] *= left_of_conductance;
      continue;
    }
    const auto middle = static_cast<std::uint32_t>(graph_.junctions++);
    graph_.from.push_back(middle);
    graph_.to.push_back(graph_.to[injury.vessel]);
    graph_.to[injury.vessel] = middle;
    conductance_[injury.vessel] *= 2;
    conductance_.push_back(conductance_[injury.vessel]);
    condition_of_.back() = conditions_.size();
    conditions_.push_back({middle, Condition::Kind::pressure, injury.orifice.outside_pressure,
                           usual_root / injury.orifice.strength});
  }
}

InjuredGraph::Result InjuredGraph::solve(const hemodynamics::GraphSolverOptions& options) {
  Result result;
  result.leaks.assign(injuries_.size(), 0.0);
  for (int round = 0; round < most_rounds; ++round) {
    result.flow = hemodynamics::solve_flow(graph_, conductance_, conditions_, options);
    double change = 0;
    for (std::size_t i = 0; i < injuries_.size(); ++i) {
      if (condition_of_[i] == none) continue;
      Condition& leak = conditions_[condition_of_[i]];
      const double drive = result.flow.pressure[leak.junction] - leak.value;
      result.leaks[i] = drive / leak.resistance;
      const double resistance = (drive > 0 ? std::sqrt(drive) : closed_root) / injuries_[i].orifice.strength;
      change = std::max(change, std::abs(resistance / leak.resistance - 1));
      leak.resistance = resistance;
    }
    if (change < tolerance) break;
  }
  result.flow.pressure.resize(junctions_);
  result.flow.flow.resize(vessels_);
  return result;
}

}  // namespace rhexis::coupling
