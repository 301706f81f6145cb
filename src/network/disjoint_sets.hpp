// SPDX-License-Identifier: BSD-3-Clause
/// Sets that grow together, such as the vessels of a branch.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace rhexis::network {

/// Items that are joined to sets, each known by its smallest item.
class DisjointSets {
 public:
  /// `smaller`: [items] a smaller item of the same set, or the item itself.
  explicit DisjointSets(std::vector<std::size_t> smaller) : smaller_(std::move(smaller)) {}
  /// `items` items, each alone in its set.
  explicit DisjointSets(std::size_t items) : smaller_(items) {
    std::iota(smaller_.begin(), smaller_.end(), std::size_t{0});
  }
  /// A new item, alone in its set.
  void add() { smaller_.push_back(smaller_.size()); }
  std::size_t of(std::size_t item) {
    while (smaller_[item] != item) item = smaller_[item] = smaller_[smaller_[item]];
    return item;
  }
  std::size_t join(std::size_t a, std::size_t b) {
    const auto [low, high] = std::minmax({of(a), of(b)});
    return smaller_[high] = low;
  }

 private:
  std::vector<std::size_t> smaller_;
};

}  // namespace rhexis::network
