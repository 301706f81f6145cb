// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/haematocrit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hemodynamics/phase_separation.hpp"

namespace rhexis::hemodynamics {
namespace {

constexpr double densest = 0.99;  ///< haematocrit; no room for more cells
/// Flows below this share of the largest are round-off: they carry nothing.
constexpr double no_flow = 1e-14;
/// The step of a vessel whose haematocrit oscillates shrinks, that of any other grows.
constexpr double shrinks = 0.5, grows = 1.1, smallest_step = 1e-4;

/// Vessels at each junction, by the direction of their blood.
struct Directed {
  std::vector<std::uint32_t> first,
      vessel;                           ///< vessels that leave junction j: vessel[first[j] .. first[j + 1])
  std::vector<double> inflow, cells;    ///< [J] what has arrived at a junction, m3/s
  std::vector<std::uint32_t> order;     ///< junctions from high pressure to low
  std::vector<std::uint32_t> bringing;  ///< [J] a vessel that brings blood, or none
  std::vector<std::uint32_t> arrivals;  ///< [J] vessels that bring blood
};

constexpr std::uint32_t none = 0xffffffff;

Directed finished(Directed d, const network::Graph& g) {
  d.inflow.assign(g.junctions, 0.0);
  d.cells.assign(g.junctions, 0.0);
  return d;
}

Directed direct(const network::Graph& g, const GraphFlow& flow, double least) {
  Directed d;
  d.first.assign(g.junctions + 1, 0);
  d.bringing.assign(g.junctions, none);
  const auto upstream = [&](std::size_t v) { return flow.flow[v] > 0 ? g.from[v] : g.to[v]; };
  const auto downstream = [&](std::size_t v) { return flow.flow[v] > 0 ? g.to[v] : g.from[v]; };
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    if (std::abs(flow.flow[v]) <= least) continue;
    ++d.first[upstream(v) + 1];
    d.bringing[downstream(v)] = static_cast<std::uint32_t>(v);
  }
  std::partial_sum(d.first.begin(), d.first.end(), d.first.begin());
  d.vessel.resize(d.first.back());
  std::vector<std::uint32_t> next(d.first.begin(), d.first.end() - 1);
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    if (std::abs(flow.flow[v]) > least) d.vessel[next[upstream(v)]++] = static_cast<std::uint32_t>(v);
  }
  // Blood can only run downhill, so a junction's turn comes when all that flows into it has arrived. Counting
  // arrivals, not comparing pressures: these may be equal to the last digit at both ends of a wide vessel.
  d.arrivals.assign(g.junctions, 0);
  for (const std::uint32_t v : d.vessel) ++d.arrivals[downstream(v)];
  std::vector<std::uint32_t> awaited = d.arrivals;
  std::size_t done = 0;
  const auto pass_on = [&] {
    for (; done < d.order.size(); ++done) {
      const std::uint32_t j = d.order[done];
      for (std::uint32_t k = d.first[j]; k < d.first[j + 1]; ++k) {
        std::uint32_t& left = awaited[downstream(d.vessel[k])];
        if (left > 0 && --left == 0) d.order.push_back(downstream(d.vessel[k]));
      }
    }
  };
  for (std::uint32_t j = 0; j < g.junctions; ++j) {
    if (awaited[j] == 0) d.order.push_back(j);
  }
  pass_on();
  if (d.order.size() == g.junctions) return finished(std::move(d), g);
  // Round-off can make tiny flows run in circles: these are cut at their highest junction.
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t j = 0; j < g.junctions; ++j) {
    if (awaited[j] > 0) waiting.push_back(j);
  }
  std::sort(waiting.begin(), waiting.end(),
            [&](std::uint32_t a, std::uint32_t b) { return flow.pressure[a] > flow.pressure[b]; });
  for (const std::uint32_t j : waiting) {
    if (awaited[j] == 0) continue;
    awaited[j] = 0;
    d.order.push_back(j);
    pass_on();
  }
  return finished(std::move(d), g);
}

}  // namespace

std::vector<double> entering_haematocrit(const network::BoundedGraph& network, double usual) {
  std::vector<double> entering;
  for (const network::BoundaryCondition& condition : network.conditions) {
    if (!condition.haematocrit) continue;
    entering.resize(network.graph.junctions, usual);
    entering[condition.junction] = *condition.haematocrit;
  }
  return entering;
}

std::vector<double> carried_haematocrit(const network::Graph& g, const GraphFlow& flow,
                                        double inflow_haematocrit, std::span<const double> entering) {
  double largest = 0;
  for (const double q : flow.flow) largest = std::max(largest, std::abs(q));
  Directed d = direct(g, flow, no_flow * largest);
  // What the solver leaves at a junction does not enter the network there.
  const double imbalance = no_flow * largest + flow.max_imbalance * flow.inflow;
  std::vector<double> haematocrit(g.vessels(), inflow_haematocrit);
  for (const std::uint32_t j : d.order) {
    const std::uint32_t begin = d.first[j], end = d.first[j + 1];
    if (begin == end) continue;
    double out = 0;
    for (std::uint32_t k = begin; k < end; ++k) out += std::abs(flow.flow[d.vessel[k]]);
    // What does not arrive through vessels enters the network here.
    const double enters = std::max(0.0, out - d.inflow[j]);
    const double mixed = (d.cells[j] + enters * (entering.empty() ? inflow_haematocrit : entering[j])) /
                         (d.inflow[j] + enters);
    const bool bifurcates = end - begin == 2 && d.arrivals[j] == 1 && enters <= imbalance + 1e-9 * out;
    for (std::uint32_t k = begin; k < end; ++k) haematocrit[d.vessel[k]] = mixed;
    if (bifurcates && mixed > 0) {
      const std::uint32_t a = d.vessel[begin], b = d.vessel[begin + 1];
      const double qa = std::abs(flow.flow[a]), qb = std::abs(flow.flow[b]);
      const double cells = mixed * (qa + qb);
      const double fraction = red_cell_fraction(qa / (qa + qb), mixed, 2e6 * g.radius_at(d.bringing[j], j),
                                                2e6 * g.radius_at(a, j), 2e6 * g.radius_at(b, j));
      const double into_a = std::clamp(cells * fraction, cells - densest * qb, densest * qa);
      haematocrit[a] = into_a / qa;
      haematocrit[b] = std::max(0.0, cells - into_a) / qb;
    }
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t v = d.vessel[k];
      const std::uint32_t there = flow.flow[v] > 0 ? g.to[v] : g.from[v];
      d.inflow[there] += std::abs(flow.flow[v]);
      d.cells[there] += std::abs(flow.flow[v]) * haematocrit[v];
    }
  }
  return haematocrit;
}

HaematocritFlow find_haematocrit(const network::Graph& graph, const FlowOfHaematocrit& solve,
                                 const HaematocritOptions& options) {
  HaematocritFlow result;
  std::vector<double> used(graph.vessels(), options.inflow_haematocrit);
  std::vector<double> step(graph.vessels(), 1.0), before(graph.vessels());
  std::int64_t solver_iterations = 0;
  while (result.iterations < options.max_iterations) {
    ++result.iterations;
    result.flow = solve(used);
    solver_iterations += result.flow.iterations;
    // What is reported is carried by the flow that is reported: cells are conserved whether this has
    // converged or not.
    result.haematocrit =
        carried_haematocrit(graph, result.flow, options.inflow_haematocrit, options.entering);
    result.change = 0;
    double moving = 0, changing = 0;
    for (std::size_t v = 0; v < used.size(); ++v) {
      const double change = result.haematocrit[v] - used[v];
      result.change = std::max(result.change, std::abs(change));
      moving += std::abs(result.flow.flow[v]);
      changing += std::abs(result.flow.flow[v] * change);
      const bool oscillates = change * before[v] < 0 && std::abs(change) > 0.5 * std::abs(before[v]);
      step[v] = oscillates ? std::max(smallest_step, shrinks * step[v]) : std::min(1.0, grows * step[v]);
      before[v] = change;
      used[v] += step[v] * change;
    }
    result.mean_change = moving > 0 ? changing / moving : 0;
    result.converged = result.change <= options.tolerance;
    if (result.converged) break;
  }
  result.flow.iterations = solver_iterations;
  return result;
}

}  // namespace rhexis::hemodynamics
