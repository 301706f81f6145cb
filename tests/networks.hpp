// SPDX-License-Identifier: BSD-3-Clause
// Networks to solve, for tests and benchmarks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "network/graph.hpp"

namespace rhexis::networks {

using network::BoundaryCondition;
using network::Graph;

inline Graph graph(std::size_t junctions,
                   const std::vector<std::pair<std::uint32_t, std::uint32_t>>& vessels) {
  Graph result;
  result.junctions = junctions;
  for (const auto& [from, to] : vessels) {
    result.from.push_back(from);
    result.to.push_back(to);
  }
  return result;
}

inline BoundaryCondition pressure(std::uint32_t junction, double value, double resistance = 0) {
  return {junction, BoundaryCondition::Kind::pressure, value, resistance};
}

inline BoundaryCondition inflow(std::uint32_t junction, double value) {
  return {junction, BoundaryCondition::Kind::flow, value, 0};
}

/// An arterial tree of k generations and its venous mirror, joined leaf to leaf: 2 (2^k - 1) vessels,
/// 3 * 2^(k-1) junctions. Artery e (1 ... 2^k - 1) is vessel e - 1 and ends at junction e; inlet 0.
struct TreePair {
  Graph graph;
  std::uint32_t inlet = 0, outlet = 0;
};

inline TreePair tree_pair(int generations) {
  const std::uint32_t past = std::uint32_t{1} << generations, first_leaf = past / 2;
  TreePair pair;
  pair.outlet = past;
  const auto venous = [&](std::uint32_t e) { return e < first_leaf ? past + e : e; };
  pair.graph.junctions = past + first_leaf;
  pair.graph.from.resize(2 * (std::size_t{past} - 1));
  pair.graph.to.resize(2 * (std::size_t{past} - 1));
  for (std::uint32_t e = 1; e < past; ++e) {
    pair.graph.from[e - 1] = e / 2;
    pair.graph.to[e - 1] = e;
    pair.graph.from[past + e - 2] = venous(e);
    pair.graph.to[past + e - 2] = venous(e / 2);
  }
  return pair;
}

/// Lognormal, stretched so that the largest is `contrast` times the smallest; 1 is halfway between.
inline std::vector<double> conductances(std::size_t count, double contrast, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> result(count);
  for (double& g : result) g = normal(random);
  if (result.empty()) return result;
  const auto [low, high] = std::minmax_element(result.begin(), result.end());
  const double scale = count > 1 ? std::log(contrast) / (*high - *low) : 0, middle = (*low + *high) / 2;
  for (double& g : result) g = std::exp(scale * (g - middle));
  return result;
}

/// Joins neighbours of a cubic lattice in random order while both have fewer than three vessels; what is not
/// connected to the most is left out. Junctions keep the lattice's order; the first is a corner or near to
/// it.
inline Graph lattice(int width, unsigned seed) {
  const auto n = static_cast<std::uint32_t>(width), count = n * n * n;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> candidates;
  for (std::uint32_t j = 0; j < count; ++j) {
    if (j % n + 1 < n) candidates.emplace_back(j, j + 1);
    if (j / n % n + 1 < n) candidates.emplace_back(j, j + n);
    if (j / n / n + 1 < n) candidates.emplace_back(j, j + n * n);
  }
  std::mt19937_64 random(seed);
  for (std::size_t i = candidates.size(); i > 1; --i) std::swap(candidates[i - 1], candidates[random() % i]);
  std::vector<int> degree(count);
  std::vector<std::uint32_t> parent(count), size(count, 1);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t j) {
    while (parent[j] != j) j = parent[j] = parent[parent[j]];
    return j;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> vessels;
  for (const auto& [a, b] : candidates) {
    if (degree[a] == 3 || degree[b] == 3) continue;
    ++degree[a];
    ++degree[b];
    vessels.emplace_back(a, b);
    const std::uint32_t ra = root(a), rb = root(b);
    if (ra == rb) continue;
    parent[ra] = rb;
    size[rb] += size[ra];
  }
  const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<std::uint32_t> number(count);
  std::uint32_t junctions = 0;
  for (std::uint32_t j = 0; j < count; ++j) number[j] = root(j) == root(largest) ? junctions++ : count;
  std::sort(vessels.begin(), vessels.end());
  Graph result;
  result.junctions = junctions;
  for (const auto& [a, b] : vessels) {
    if (number[a] == count) continue;
    result.from.push_back(number[a]);
    result.to.push_back(number[b]);
  }
  return result;
}

}  // namespace rhexis::networks
