// SPDX-License-Identifier: BSD-3-Clause
// A rank's part of the tree pair as an explicit graph of its own.
#include <algorithm>
#include <bit>
#include <unordered_map>

#include "network/tree/tree_pair.hpp"

namespace rhexis::network {
namespace {

/// Places that a part has: all of generations [0, cut) for the first part, and from generation `cut` on those
/// below its share of that generation.
struct PlaceSet {
  int cut;
  std::uint64_t first, past;  ///< range of the part's vessels within generation `cut`
  bool top;

  bool has(std::uint64_t place) const {
    const int generation = TreePair::generation_of(place);
    if (generation < cut) return top;
    const std::uint64_t ancestor = (place >> (generation - cut)) - (std::uint64_t{1} << cut);
    return ancestor >= first && ancestor < past;
  }
  /// Whether the part has the place or something below it.
  bool leads_to(std::uint64_t place) const {
    const int generation = TreePair::generation_of(place);
    if (generation >= cut || top) return has(place);
    const std::uint64_t low = (place << (cut - generation)) - (std::uint64_t{1} << cut);
    return low < past && low + (std::uint64_t{1} << (cut - generation)) > first;
  }
};

struct PartBuilder {
  const TreePair& tree;
  PlaceSet places;
  TreePair::Part part;
  std::unordered_map<std::int64_t, std::uint32_t> local;  ///< junctions by their numbers in the whole

  std::uint32_t junction(std::uint64_t number, const Point& position) {
    const auto [found, isnew] = local.try_emplace(static_cast<std::int64_t>(number),
                                                  static_cast<std::uint32_t>(part.graph.junctions));
    if (isnew) {
      ++part.graph.junctions;
      part.junction_id.push_back(found->first);
      part.graph.x.push_back(position[0]);
      part.graph.y.push_back(position[1]);
      part.graph.z.push_back(position[2]);
    }
    return found->second;
  }

  void put(std::uint64_t place, const Point& start, const TreePair::Place& at) {
    const std::uint64_t outlet = std::uint64_t{1} << tree.generations();
    const bool last = 2 * place > tree.places();
    Graph& g = part.graph;
    const int generation = TreePair::generation_of(place);
    const double radius = tree.radius_of(at.capacity);
    const double length = tree.rules().length(generation, radius) * tree.length_factor(place);
    const std::uint32_t far = junction(place, at.end);
    g.from.push_back(junction(place / 2, start));
    g.to.push_back(far);
    g.from.push_back(last ? far : junction(outlet + place, TreePair::mirrored(at.end)));
    g.to.push_back(junction(outlet + place / 2, TreePair::mirrored(start)));
    for (const VesselKind kind : {VesselKind::artery, VesselKind::vein}) {
      g.radius.push_back(kind == VesselKind::artery ? radius : radius * tree.rules().vein_radius_ratio);
      g.length.push_back(length);
      g.kind.push_back(kind);
      g.generation.push_back(static_cast<std::int8_t>(generation));
      part.vessel_id.push_back(static_cast<std::int64_t>(TreePair::id_of(place, kind)));
    }
  }
};

}  // namespace

TreePair::Part TreePair::materialise_part(int part, int parts) const {
  // Cut where there are some places for every part.
  const int cut =
      std::min(generations() - 1, 3 + static_cast<int>(std::bit_width(static_cast<unsigned>(parts))));
  const std::uint64_t count = std::uint64_t{1} << cut;
  const auto share = [&](int p) {
    return count * static_cast<std::uint64_t>(p) / static_cast<std::uint64_t>(parts);
  };
  PartBuilder builder{*this, {cut, share(part), share(part + 1), part == 0}, {}, {}};
  struct Visit {
    std::uint64_t place;
    Point start;
    Place at;
  };
  std::vector<Visit> generation{{1, inlet(), root_place()}}, next;
  while (!generation.empty()) {
    next.clear();
    for (const Visit& v : generation) {
      if (builder.places.has(v.place)) builder.put(v.place, v.start, v.at);
      if (2 * v.place > places()) continue;
      const auto below = daughters(v.place, v.at);
      for (std::uint64_t i = 0; i < 2; ++i) {
        if (builder.places.leads_to(2 * v.place + i)) next.push_back({2 * v.place + i, v.at.end, below[i]});
      }
    }
    generation.swap(next);
  }
  return std::move(builder.part);
}

}  // namespace rhexis::network
