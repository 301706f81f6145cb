// SPDX-License-Identifier: BSD-3-Clause
/// Which places of a huge tree to store and draw: a picture cannot tell 34 billion vessels apart.
#pragma once

#include <cstdint>
#include <vector>

#include "network/tree/tree_pair.hpp"

namespace rhexis::network {

/// A chosen place with its geometry.
struct SelectedPlace {
  std::uint64_t place = 1;
  Point near{};        ///< near end of the artery
  TreePair::Place at;  ///< its capacity and far end
};

/// At most `count` places from `top` on, the widest vessels first, so that every place comes with its
/// ancestors up to `top`; in the order of a walk through the tree (parents first, neighbours close together).
std::vector<SelectedPlace> widest_places(const TreePair& tree, std::uint64_t top, std::size_t count);

}  // namespace rhexis::network
