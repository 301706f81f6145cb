// SPDX-License-Identifier: BSD-3-Clause
// The whole tree pair as an explicit graph, generation by generation. No temporary arrays: radii hold
// capacities until the end.
#include <cstdint>

#include "core/error.hpp"
#include "network/tree/tree_pair.hpp"
#include "parallel/communicator.hpp"
#include "parallel/large_array.hpp"
#include "parallel/threads.hpp"

namespace rhexis::network {
namespace {

/// Calls work(h) for all places h of [first, past), by all threads.
template <class Work>
void for_each_place(std::uint64_t first, std::uint64_t past, const Work& work) {
  parallel::for_each_share(parallel::thread_count(), past - first,
                           [&](int, std::size_t begin, std::size_t end) {
                             for (std::size_t i = begin; i < end; ++i) work(first + i);
                           });
}

struct Builder {
  const TreePair& tree;
  Graph& graph;
  bool coordinates;
  std::uint64_t outlet = std::uint64_t{1} << tree.generations();
  std::uint64_t first_last = outlet >> 1;  ///< first place of the last generation

  std::uint64_t far_vein(std::uint64_t place) const { return place >= first_last ? place : outlet + place; }

  void put(std::uint64_t place, const TreePair::Place& at) const {
    const std::uint64_t artery = TreePair::id_of(place, VesselKind::artery), vein = artery + 1;
    graph.radius[artery] = at.capacity;
    graph.from[artery] = static_cast<std::uint32_t>(place / 2);
    graph.to[artery] = static_cast<std::uint32_t>(place);
    graph.from[vein] = static_cast<std::uint32_t>(far_vein(place));
    graph.to[vein] = static_cast<std::uint32_t>(outlet + place / 2);
    const auto generation = static_cast<std::int8_t>(TreePair::generation_of(place));
    graph.generation[artery] = graph.generation[vein] = generation;
    graph.kind[artery] = VesselKind::artery;
    graph.kind[vein] = VesselKind::vein;
    if (!coordinates) return;
    put_point(place, at.end);
    if (place < first_last) put_point(outlet + place, TreePair::mirrored(at.end));
  }

  void put_point(std::uint64_t junction, const Point& p) const {
    graph.x[junction] = p[0];
    graph.y[junction] = p[1];
    graph.z[junction] = p[2];
  }

  TreePair::Place at(std::uint64_t place) const {
    TreePair::Place p{graph.radius[TreePair::id_of(place, VesselKind::artery)], {}};
    if (coordinates) p.end = {graph.x[place], graph.y[place], graph.z[place]};
    return p;
  }

  void put_daughters(std::uint64_t place) const {
    if (coordinates) {
      const auto daughters = tree.daughters(place, at(place));
      put(2 * place, daughters[0]);
      put(2 * place + 1, daughters[1]);
    } else {
      const double capacity = at(place).capacity, first = capacity * tree.first_share(place);
      put(2 * place, {first, {}});
      put(2 * place + 1, {capacity - first, {}});
    }
  }

  void turn_into_radius(std::uint64_t place) const {
    const std::uint64_t artery = TreePair::id_of(place, VesselKind::artery);
    const double radius = tree.radius_of(graph.radius[artery]);
    graph.radius[artery] = radius;
    graph.radius[artery + 1] = radius * tree.rules().vein_radius_ratio;
    graph.length[artery] = graph.length[artery + 1] =
        tree.rules().length(TreePair::generation_of(place), radius) * tree.length_factor(place);
  }
};

}  // namespace

Graph TreePair::materialise(bool coordinates) const {
  if (generations() > 30) {
    throw RunError("a tree pair of " + std::to_string(generations()) +
                   " generations does not fit an explicit graph; 30 is the most");
  }
  Graph graph;
  graph.junctions = junctions();
  graph.from = parallel::large_array<std::uint32_t>(vessels());
  graph.to = parallel::large_array<std::uint32_t>(vessels());
  graph.radius = parallel::large_array<double>(vessels());
  graph.length = parallel::large_array<double>(vessels());
  graph.kind = parallel::large_array<VesselKind>(vessels());
  graph.generation = parallel::large_array<std::int8_t>(vessels());
  if (coordinates) {
    graph.x = parallel::large_array<double>(graph.junctions);
    graph.y = parallel::large_array<double>(graph.junctions);
    graph.z = parallel::large_array<double>(graph.junctions);
  }
  const Builder builder{*this, graph, coordinates};
  if (coordinates) {
    builder.put_point(0, inlet());
    builder.put_point(builder.outlet, mirrored(inlet()));
  }
  builder.put(1, root_place());
  for (std::uint64_t first = 1; first < builder.first_last; first *= 2) {
    for_each_place(first, 2 * first, [&](std::uint64_t place) { builder.put_daughters(place); });
  }
  for_each_place(1, builder.outlet, [&](std::uint64_t place) { builder.turn_into_radius(place); });
  return graph;
}

}  // namespace rhexis::network
