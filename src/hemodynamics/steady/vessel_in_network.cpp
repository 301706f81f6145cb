// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/vessel_in_network.hpp"

#include <algorithm>
#include <cmath>

#include "hemodynamics/steady/graph/graph_flow.hpp"

namespace rhexis::hemodynamics {
namespace {

using network::BoundaryCondition;

/// Tighter than the balance that a coupled run promises.
constexpr double imbalance_of_solver = 1e-12;

class InTree : public VesselInNetwork {
 public:
  InTree(const TreeFlow& flow, std::uint64_t vessel) : tree_(flow, {vessel}), vessel_(vessel) {}

  VesselState solve(double resistance_factor, double leak_conductance,
                    double outside_pressure) const override {
    const auto r = tree_.solve({{vessel_, resistance_factor, leak_conductance, outside_pressure}});
    const auto& v = r.vessels.front();
    const auto in = [](double flow) { return std::max(flow, 0.0); };
    return {.inflow = in(r.inflow) + in(-r.outflow),
            .outflow = in(r.outflow) + in(-r.inflow),
            .flow_from = v.flow_from,
            .flow_to = v.flow_to,
            .leak = v.leak,
            .pressure_from = v.pressure_from,
            .pressure_middle = v.pressure_middle,
            .pressure_to = v.pressure_to};
  }

 private:
  ChangedTree tree_;
  std::uint64_t vessel_;
};

class InGraph : public VesselInNetwork {
 public:
  /// The vessel is cut in two halves that meet at a new junction.
  InGraph(network::Graph graph, std::vector<double> conductance, std::vector<BoundaryCondition> conditions,
          std::uint32_t vessel)
      : graph_(std::move(graph)),
        conductance_(std::move(conductance)),
        conditions_(std::move(conditions)),
        vessel_(vessel),
        whole_conductance_(conductance_[vessel]) {
    middle_ = static_cast<std::uint32_t>(graph_.junctions++);
    graph_.junction_name.clear();
    graph_.vessel_name.clear();
    graph_.from.push_back(middle_);
    graph_.to.push_back(graph_.to[vessel_]);
    graph_.to[vessel_] = middle_;
    conductance_.push_back(0);
  }

  VesselState solve(double resistance_factor, double leak_conductance,
                    double outside_pressure) const override {
    std::vector<double> conductance = conductance_;
    conductance[vessel_] = conductance.back() = 2 * whole_conductance_ / resistance_factor;
    std::vector<BoundaryCondition> conditions = conditions_;
    if (leak_conductance > 0) {
      conditions.push_back(
          {middle_, BoundaryCondition::Kind::pressure, outside_pressure, 1 / leak_conductance});
    }
    const GraphFlow flow =
        solve_flow(graph_, std::move(conductance), conditions, {.imbalance = imbalance_of_solver});
    VesselState s;
    s.flow_from = flow.flow[vessel_];
    s.flow_to = flow.flow.back();
    s.pressure_from = flow.pressure[graph_.from[vessel_]];
    s.pressure_middle = flow.pressure[middle_];
    s.pressure_to = flow.pressure[graph_.to.back()];
    s.leak = leak_conductance * (s.pressure_middle - outside_pressure);
    std::vector<double> carried_away(graph_.junctions);  // by a junction's vessels, m3/s
    for (std::size_t v = 0; v < graph_.vessels(); ++v) {
      carried_away[graph_.from[v]] += flow.flow[v];
      carried_away[graph_.to[v]] -= flow.flow[v];
    }
    for (const BoundaryCondition& c : conditions_) {
      const double in = carried_away[c.junction];
      (in > 0 ? s.inflow : s.outflow) += std::abs(in);
    }
    return s;
  }

 private:
  network::Graph graph_;
  std::vector<double> conductance_;
  std::vector<BoundaryCondition> conditions_;
  std::uint32_t vessel_, middle_ = 0;
  double whole_conductance_;
};

}  // namespace

double VesselState::imbalance() const {
  const double through = std::max({std::abs(inflow), std::abs(outflow), std::abs(leak)});
  return through > 0 ? std::abs(inflow - outflow - leak) / through : 0;
}

std::unique_ptr<VesselInNetwork> vessel_in_tree(const TreeFlow& flow, std::uint64_t vessel) {
  return std::make_unique<InTree>(flow, vessel);
}

std::unique_ptr<VesselInNetwork> vessel_in_graph(network::Graph graph, std::vector<double> conductance,
                                                 std::vector<BoundaryCondition> conditions,
                                                 std::uint32_t vessel) {
  return std::make_unique<InGraph>(std::move(graph), std::move(conductance), std::move(conditions), vessel);
}

}  // namespace rhexis::hemodynamics
