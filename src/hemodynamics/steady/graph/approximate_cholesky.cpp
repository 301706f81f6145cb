// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/approximate_cholesky.hpp"

#include <Random123/philox.h>

#include <algorithm>
#include <cassert>

namespace rhexis::hemodynamics {
namespace {

constexpr std::uint32_t none = 0xffffffff;

/// Uniform in [0, 1), number `draw` of `vertex`.
double uniform(std::uint32_t vertex, std::uint32_t draw) {
  const r123::Philox2x32::ctr_type counter = {{vertex, draw}};
  const r123::Philox2x32::key_type key = {{0x52686578}};
  const auto bits = r123::Philox2x32()(counter, key);
  return 0x1p-53 * static_cast<double>((std::uint64_t{bits[0]} << 32 | bits[1]) >> 11);
}

struct Neighbour {
  double weight;
  std::uint32_t vertex;
};

/// A graph from which vertices are taken while vessels are added: lists of half-vessels in one pool. Halves
/// that lead to vertices already taken stay until their own vertex is.
class ShrinkingGraph {
 public:
  explicit ShrinkingGraph(const CoreSystem& system);

  /// The vertex to take next, of least degree.
  std::uint32_t next();
  /// Takes it: its neighbours, parallel vessels summed, by ascending weight; the ground is number
  /// `vertices()`.
  const std::vector<Neighbour>& take(std::uint32_t vertex);
  void connect(std::uint32_t a, std::uint32_t b, double weight);
  /// After a vertex was taken and its vessels were added: files its neighbours by their new degrees.
  void file(const std::vector<Neighbour>& changed);
  std::uint32_t vertices() const { return static_cast<std::uint32_t>(head_.size()); }

 private:
  struct Half {
    double weight;
    std::uint32_t vertex, next;
  };
  static constexpr std::uint32_t buckets = 64;  // by degree; the last one holds all that are larger
  static constexpr std::uint32_t taken = none;

  void push(std::uint32_t at, std::uint32_t to, double weight);
  void file(std::uint32_t vertex);
  static std::uint32_t bucket_of(std::uint32_t degree) { return std::min(degree, buckets - 1); }

  std::vector<Half> pool_;
  std::uint32_t free_ = none;
  std::vector<std::uint32_t> head_;    // [n] first half of a vertex
  std::vector<std::uint32_t> degree_;  // [n] halves that lead to vertices not taken; `taken`
  std::vector<double> ground_;         // [n] weight towards the ground
  std::vector<std::uint32_t> place_;   // [n] in neighbours_, while one vertex is taken
  std::vector<Neighbour> neighbours_;
  std::vector<std::uint32_t> bucket_[buckets];  // entries whose degree has changed since are passed over
  std::uint32_t lowest_ = 0;
};

ShrinkingGraph::ShrinkingGraph(const CoreSystem& system)
    : head_(system.unknowns(), none),
      degree_(system.unknowns()),
      ground_(system.unknowns()),
      place_(system.unknowns(), none) {
  pool_.reserve(system.entries());
  for (std::uint32_t j = 0; j < vertices(); ++j) {
    const auto neighbours = system.neighbours(j);
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      if (neighbours[k] < vertices()) {
        push(j, neighbours[k], system.weights(j)[k]);
      } else {
        ground_[j] += system.weights(j)[k];
      }
    }
  }
  for (std::uint32_t j = vertices(); j-- > 0;) file(j);
}

void ShrinkingGraph::push(std::uint32_t at, std::uint32_t to, double weight) {
  std::uint32_t half = free_;
  if (half != none) {
    free_ = pool_[half].next;
  } else {
    half = static_cast<std::uint32_t>(pool_.size());
    pool_.emplace_back();
  }
  pool_[half] = {weight, to, head_[at]};
  head_[at] = half;
  ++degree_[at];
}

void ShrinkingGraph::file(std::uint32_t vertex) {
  const std::uint32_t bucket = bucket_of(degree_[vertex]);
  bucket_[bucket].push_back(vertex);
  lowest_ = std::min(lowest_, bucket);
}

void ShrinkingGraph::file(const std::vector<Neighbour>& changed) {
  for (const auto& [weight, vertex] : changed) {
    if (vertex < vertices()) file(vertex);
  }
}

std::uint32_t ShrinkingGraph::next() {
  while (true) {
    while (bucket_[lowest_].empty()) ++lowest_;
    const std::uint32_t vertex = bucket_[lowest_].back();
    bucket_[lowest_].pop_back();
    if (degree_[vertex] != taken && bucket_of(degree_[vertex]) == lowest_) return vertex;
  }
}

const std::vector<Neighbour>& ShrinkingGraph::take(std::uint32_t vertex) {
  neighbours_.clear();
  for (std::uint32_t half = head_[vertex]; half != none;) {
    const auto [weight, to, next] = pool_[half];
    if (degree_[to] != taken) {
      --degree_[to];
      if (place_[to] == none) {
        place_[to] = static_cast<std::uint32_t>(neighbours_.size());
        neighbours_.push_back({0, to});
      }
      neighbours_[place_[to]].weight += weight;
    }
    pool_[half].next = free_;
    free_ = half;
    half = next;
  }
  for (const Neighbour& neighbour : neighbours_) place_[neighbour.vertex] = none;
  if (ground_[vertex] > 0) neighbours_.push_back({ground_[vertex], vertices()});
  degree_[vertex] = taken;
  std::sort(neighbours_.begin(), neighbours_.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.weight != b.weight ? a.weight < b.weight : a.vertex < b.vertex;
  });
  return neighbours_;
}

void ShrinkingGraph::connect(std::uint32_t a, std::uint32_t b, double weight) {
  if (a == vertices()) {
    ground_[b] += weight;
  } else if (b == vertices()) {
    ground_[a] += weight;
  } else {
    push(a, b, weight);
    push(b, a, weight);
  }
}

}  // namespace

ApproximateCholesky::ApproximateCholesky(const CoreSystem& system) : first_(1), work_(system.unknowns()) {
  ShrinkingGraph graph(system);
  const std::uint32_t ground = graph.vertices();
  std::vector<double> heavier;  // sums of weights [i, d)
  order_.reserve(ground);
  pivot_.reserve(ground);
  for (std::uint32_t n = 0; n < ground; ++n) {
    const std::uint32_t vertex = graph.next();
    const auto& neighbours = graph.take(vertex);
    const std::size_t count = neighbours.size();
    heavier.assign(count + 1, 0.0);
    for (std::size_t i = count; i-- > 0;) heavier[i] = heavier[i + 1] + neighbours[i].weight;
    const double sum = heavier[0];
    for (std::uint32_t i = 0; i + 1 < count; ++i) {
      // The last k with heavier[k] >= target: it is drawn with probability w_k / S_i.
      const double target = (1 - uniform(vertex, i)) * heavier[i + 1];
      const auto past =
          std::partition_point(heavier.begin() + i + 2, heavier.begin() + static_cast<std::ptrdiff_t>(count),
                               [&](double s) { return s >= target; });
      const auto partner = static_cast<std::size_t>(past - heavier.begin()) - 1;
      graph.connect(neighbours[i].vertex, neighbours[partner].vertex,
                    neighbours[i].weight * (heavier[i + 1] / sum));
    }
    for (const auto& [weight, to] : neighbours) {
      if (to == ground) continue;
      row_.push_back(to);
      share_.push_back(weight / sum);
    }
    order_.push_back(vertex);
    first_.push_back(static_cast<std::uint32_t>(row_.size()));
    pivot_.push_back(sum);
    graph.file(neighbours);
  }
  std::vector<std::uint32_t> number(ground);
  for (std::uint32_t n = 0; n < ground; ++n) number[order_[n]] = n;
  for (std::uint32_t& row : row_) row = number[row];
}

void ApproximateCholesky::apply(std::span<const double> residual, std::span<double> result) {
  const std::size_t count = order_.size();
  for (std::size_t n = 0; n < count; ++n) work_[n] = residual[order_[n]];
  for (std::size_t n = 0; n < count; ++n) {
    const double value = work_[n];
    for (std::uint32_t k = first_[n]; k < first_[n + 1]; ++k) work_[row_[k]] += share_[k] * value;
    work_[n] = value / pivot_[n];
  }
  for (std::size_t n = count; n-- > 0;) {
    double value = work_[n];
    for (std::uint32_t k = first_[n]; k < first_[n + 1]; ++k) value += share_[k] * work_[row_[k]];
    work_[n] = value;
    result[order_[n]] = value;
  }
}

}  // namespace rhexis::hemodynamics
