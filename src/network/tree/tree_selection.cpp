// SPDX-License-Identifier: BSD-3-Clause
#include "network/tree/tree_selection.hpp"

#include <algorithm>
#include <queue>

namespace rhexis::network {
namespace {

/// Before its daughters, and next to them.
bool walks_before(const SelectedPlace& a, const SelectedPlace& b) {
  const auto key = [](std::uint64_t place) { return place << (63 - TreePair::generation_of(place)); };
  return key(a.place) != key(b.place) ? key(a.place) < key(b.place) : a.place < b.place;
}

SelectedPlace select(const TreePair& tree, std::uint64_t place) {
  SelectedPlace s{1, tree.inlet(), tree.root_place()};
  for (int bit = TreePair::generation_of(place) - 1; bit >= 0; --bit) {
    const std::uint64_t parent = place >> (bit + 1), step = place >> bit & 1;
    s = {2 * parent + step, s.at.end, tree.daughters(parent, s.at)[step]};
  }
  return s;
}

}  // namespace

std::vector<SelectedPlace> widest_places(const TreePair& tree, std::uint64_t top, std::size_t count) {
  // Equal vessels in the order of their numbers: generation by generation.
  const auto after = [](const SelectedPlace& a, const SelectedPlace& b) {
    return a.at.capacity != b.at.capacity ? a.at.capacity < b.at.capacity : a.place > b.place;
  };
  std::priority_queue<SelectedPlace, std::vector<SelectedPlace>, decltype(after)> candidates(after);
  candidates.push(select(tree, top));
  std::vector<SelectedPlace> chosen;
  while (!candidates.empty() && chosen.size() < count) {
    const SelectedPlace widest = candidates.top();
    candidates.pop();
    chosen.push_back(widest);
    if (2 * widest.place > tree.places()) continue;
    const auto daughters = tree.daughters(widest.place, widest.at);
    for (std::uint64_t i = 0; i < 2; ++i) {
      candidates.push({2 * widest.place + i, widest.at.end, daughters[static_cast<std::size_t>(i)]});
    }
  }
  std::sort(chosen.begin(), chosen.end(), walks_before);
  return chosen;
}

}  // namespace rhexis::network
