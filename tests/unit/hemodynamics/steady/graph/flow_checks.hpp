// SPDX-License-Identifier: BSD-3-Clause
// What every solution must satisfy, and a dense reference in long double.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "networks.hpp"

namespace rhexis::hemodynamics {

/// Worst imbalance at junctions without a condition of pressure, summed in long double, relative to inflow.
inline double imbalance_of(const network::Graph& graph,
                           const std::vector<network::BoundaryCondition>& conditions,
                           const GraphFlow& result) {
  std::vector<long double> sum(graph.junctions);
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    sum[graph.from[v]] -= result.flow[v];
    sum[graph.to[v]] += result.flow[v];
  }
  for (const auto& condition : conditions) {
    const std::uint32_t j = condition.junction;
    if (condition.kind == network::BoundaryCondition::Kind::flow) {
      sum[j] += condition.value;
    } else if (condition.resistance == 0) {
      sum[j] = 0;
    } else {
      sum[j] -= (result.pressure[j] - condition.value) / condition.resistance;
    }
  }
  long double worst = 0;
  for (const long double s : sum) worst = std::max(worst, std::abs(s));
  return static_cast<double>(worst / static_cast<long double>(result.inflow));
}

struct Reference {
  std::vector<long double> pressure, flow;
};

/// Gaussian elimination without subtractions (what leaves a junction is the sum of its conductances), dense,
/// in long double; conditions of pressure (at least one) without resistance, and of flow.
inline Reference reference(const network::Graph& graph, const std::vector<double>& conductance,
                           const std::vector<network::BoundaryCondition>& conditions) {
  using Real = long double;
  const std::size_t count = graph.junctions;
  std::vector<std::vector<Real>> g(count, std::vector<Real>(count));
  std::vector<Real> injection(count), total(count);
  std::vector<bool> fixed(count);
  Reference result{std::vector<Real>(count), {}};
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    g[graph.from[v]][graph.to[v]] += conductance[v];
    g[graph.to[v]][graph.from[v]] += conductance[v];
  }
  for (const auto& condition : conditions) {
    const bool is_pressure = condition.kind == network::BoundaryCondition::Kind::pressure;
    fixed[condition.junction] = is_pressure;
    (is_pressure ? result.pressure : injection)[condition.junction] = condition.value;
  }
  std::vector<bool> left(count, true);
  for (std::size_t j = 0; j < count; ++j) {
    if (fixed[j]) continue;
    left[j] = false;
    for (std::size_t k = 0; k < count; ++k) total[j] += left[k] ? g[j][k] : 0;
    for (std::size_t a = 0; a < count; ++a) {
      if (!left[a] || g[j][a] == 0) continue;
      injection[a] += injection[j] * g[j][a] / total[j];
      for (std::size_t b = 0; b < count; ++b) {
        if (left[b] && b != a) g[a][b] += g[j][a] * g[j][b] / total[j];
      }
    }
  }
  for (std::size_t j = count; j-- > 0;) {
    if (fixed[j]) continue;
    Real sum = injection[j];
    for (std::size_t k = 0; k < count; ++k) sum += left[k] ? g[j][k] * result.pressure[k] : 0;
    result.pressure[j] = sum / total[j];
    left[j] = true;
  }
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    result.flow.push_back(conductance[v] * (result.pressure[graph.from[v]] - result.pressure[graph.to[v]]));
  }
  return result;
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = a.size() == b.size() ? 0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

}  // namespace rhexis::hemodynamics
