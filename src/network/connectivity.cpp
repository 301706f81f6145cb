// SPDX-License-Identifier: BSD-3-Clause
#include "network/connectivity.hpp"

#include <algorithm>
#include <numeric>

namespace rhexis::network {
namespace {

/// The vessels at junction j: vessel[first[j] .. first[j + 1]).
struct Incidence {
  std::vector<std::uint32_t> first, vessel;
};

Incidence incidence_of(const Graph& graph) {
  Incidence at;
  at.first.assign(graph.junctions + 1, 0);
  const std::vector<std::uint32_t> degree = degrees(graph);
  std::partial_sum(degree.begin(), degree.end(), at.first.begin() + 1);
  at.vessel.resize(at.first.back());
  std::vector<std::uint32_t> next(at.first.begin(), at.first.end() - 1);
  for (std::uint32_t v = 0; v < graph.vessels(); ++v) {
    at.vessel[next[graph.from[v]]++] = v;
    at.vessel[next[graph.to[v]]++] = v;
  }
  return at;
}

/// The graph with one more junction, the outside, which a vessel joins to every open condition. A vessel can
/// carry flow where it belongs to a biconnected component of the outside; these are found by depth-first
/// search (Hopcroft & Tarjan 1973, doi:10.1145/362248.362272).
class OutsideSearch {
 public:
  OutsideSearch(const Graph& graph, std::span<const BoundaryCondition> conditions)
      : graph_(graph),
        at_(incidence_of(graph)),
        open_(graph.junctions),
        rank_(graph.junctions, unreached),
        low_(graph.junctions),
        via_(graph.junctions, none) {
    for (const BoundaryCondition& condition : conditions)
      if (is_open(condition)) open_[condition.junction] = true;
    next_.assign(at_.first.begin(), at_.first.end() - 1);
    for (const BoundaryCondition& condition : conditions)
      if (is_open(condition) && rank_[condition.junction] == unreached) search_from(condition.junction);
  }

  std::vector<bool> vessels() const {
    // Whether the vessel by which a junction was reached shares a component with the outside.
    std::vector<bool> shares(graph_.junctions);
    for (const std::uint32_t j : reached_) {
      if (via_[j] == none) {
        shares[j] = true;
        continue;
      }
      const std::uint32_t parent = other_end(via_[j], j);
      shares[j] = shares[parent] && low_[j] < rank_[parent];
    }
    std::vector<bool> carries(graph_.vessels());
    for (std::size_t v = 0; v < carries.size(); ++v) {
      const std::uint32_t a = graph_.from[v], b = graph_.to[v];
      carries[v] = a != b && shares[rank_[a] > rank_[b] ? a : b];
    }
    return carries;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff, unreached = 0;

  std::uint32_t other_end(std::uint32_t v, std::uint32_t j) const {
    return graph_.from[v] == j ? graph_.to[v] : graph_.from[v];
  }

  /// `rank_` counts junctions from 1 in the order of their discovery; the outside has 0. `low_` is the lowest
  /// rank that is reached from a junction and those below it by one vessel that is not `via_`.
  void discover(std::uint32_t j, std::uint32_t via) {
    reached_.push_back(j);
    rank_[j] = static_cast<std::uint32_t>(reached_.size());
    via_[j] = via;
    low_[j] = open_[j] && via != none ? 0 : rank_[j];
    path_.push_back(j);
  }

  void search_from(std::uint32_t start) {
    discover(start, none);
    while (!path_.empty()) {
      const std::uint32_t j = path_.back();
      if (next_[j] < at_.first[j + 1]) {
        const std::uint32_t v = at_.vessel[next_[j]++];
        if (v == via_[j]) continue;
        const std::uint32_t there = other_end(v, j);
        if (rank_[there] == unreached) {
          discover(there, v);
        } else {
          low_[j] = std::min(low_[j], rank_[there]);
        }
        continue;
      }
      path_.pop_back();
      if (!path_.empty()) low_[path_.back()] = std::min(low_[path_.back()], low_[j]);
    }
  }

  const Graph& graph_;
  Incidence at_;
  std::vector<bool> open_;                       // [J]
  std::vector<std::uint32_t> rank_, low_, via_;  // [J]
  std::vector<std::uint32_t> next_;              // [J] the next entry of at_.vessel to follow
  std::vector<std::uint32_t> reached_, path_;    // in the order of discovery; from the start to here
};

}  // namespace

std::vector<std::uint32_t> first_of_part(const Graph& graph) {
  std::vector<std::uint32_t> towards(graph.junctions);
  std::iota(towards.begin(), towards.end(), 0u);
  const auto first = [&](std::uint32_t j) {
    while (towards[j] != j) j = towards[j] = towards[towards[j]];
    return j;
  };
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    const std::uint32_t a = first(graph.from[v]), b = first(graph.to[v]);
    towards[std::max(a, b)] = std::min(a, b);
  }
  for (std::uint32_t j = 0; j < graph.junctions; ++j) towards[j] = first(j);
  return towards;
}

std::vector<std::uint32_t> degrees(const Graph& graph) {
  std::vector<std::uint32_t> degree(graph.junctions);
  for (const auto* ends : {&graph.from, &graph.to})
    for (const std::uint32_t j : *ends) ++degree[j];
  return degree;
}

bool is_open(const BoundaryCondition& condition) {
  return condition.kind == BoundaryCondition::Kind::pressure || condition.value != 0;
}

std::vector<bool> can_carry_flow(const Graph& graph, std::span<const BoundaryCondition> conditions) {
  return OutsideSearch(graph, conditions).vessels();
}

}  // namespace rhexis::network
