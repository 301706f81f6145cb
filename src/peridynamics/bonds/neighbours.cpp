// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/bonds/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.hpp"

namespace rhexis::peridynamics {
namespace {

/// Particles sorted into cubic cells, those of one cell in ascending order.
class Cells {
 public:
  Cells(const ParticleSet& set, double width) : set_(&set), width_(width) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [least, most] = std::minmax_element(set.position[k].begin(), set.position[k].end());
      origin_[k] = *least;
      count_[k] = 1 + static_cast<std::int64_t>((*most - *least) / width);
    }
    first_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]) + 1, 0);
    for (std::size_t i = 0; i < set.size(); ++i) ++first_[index(cell_of(i)) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    sorted_.resize(set.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < set.size(); ++i)
      sorted_[next[index(cell_of(i))]++] = static_cast<std::int32_t>(i);
  }

  std::array<std::int64_t, 3> cell_of(std::size_t i) const {
    std::array<std::int64_t, 3> cell;
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = static_cast<std::int64_t>((set_->position[k][i] - origin_[k]) / width_);
    return cell;
  }

  /// Calls use(j) for all particles in the cell of `i` and in those around it.
  template <class Use>
  void for_each_near(std::size_t i, const Use& use) const {
    const std::array<std::int64_t, 3> cell = cell_of(i);
    const auto low = [&](std::size_t k) { return std::max<std::int64_t>(cell[k] - 1, 0); };
    const auto high = [&](std::size_t k) { return std::min(cell[k] + 1, count_[k] - 1); };
    for (std::int64_t x = low(0); x <= high(0); ++x) {
      for (std::int64_t y = low(1); y <= high(1); ++y) {
        // Cells along z lie one after another.
        const std::size_t begin = first_[index({x, y, low(2)})], past = first_[index({x, y, high(2)}) + 1];
        for (std::size_t p = begin; p < past; ++p) use(static_cast<std::size_t>(sorted_[p]));
      }
    }
  }

 private:
  std::size_t index(const std::array<std::int64_t, 3>& c) const {
    return static_cast<std::size_t>((c[0] * count_[1] + c[1]) * count_[2] + c[2]);
  }

  const ParticleSet* set_;
  double width_;
  Vector3 origin_{};
  std::array<std::int64_t, 3> count_{};
  std::vector<std::size_t> first_;
  std::vector<std::int32_t> sorted_;
};

double squared_distance(const ParticleSet& set, std::size_t i, std::size_t j) {
  double sum = 0;
  for (const std::vector<double>& x : set.position) sum += (x[j] - x[i]) * (x[j] - x[i]);
  return sum;
}

std::string place(const ParticleSet& set, std::size_t i) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", set.position[0][i], set.position[1][i],
                     set.position[2][i]);
}

/// Every third bit from the lowest 21 of `x`.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

}  // namespace

Neighbours find_neighbours(const ParticleSet& set, double horizon, const Separation* cut) {
  const Cells cells(set, horizon);
  // Pairs at the horizon itself belong to it, whatever rounding makes of their distance.
  const double limit = std::pow(horizon * (1 + 1e-9), 2), coincident = std::pow(1e-6 * set.spacing, 2);
  Neighbours result;
  result.first.reserve(set.size() + 1);
  result.first.push_back(0);
  for (std::size_t i = 0; i < set.size(); ++i) {
    cells.for_each_near(i, [&](std::size_t j) {
      const double distance2 = squared_distance(set, i, j);
      if (j == i || distance2 > limit) return;
      if (distance2 < coincident)
        throw InputError(fmt::format("particles {} and {} coincide at {}", i, j, place(set, i)));
      if (cut == nullptr || !cut->between(set.at(i), set.at(j)))
        result.partner.push_back(static_cast<std::int32_t>(j));
    });
    const auto begin = result.partner.begin() + static_cast<std::ptrdiff_t>(result.first.back());
    std::sort(begin, result.partner.end());
    if (begin == result.partner.end())
      throw InputError(fmt::format("particle {} at {} has no neighbour within the horizon of {:.6g} m", i,
                                   place(set, i), horizon));
    result.first.push_back(result.partner.size());
  }
  return result;
}

std::vector<std::size_t> local_order(const ParticleSet& set, double horizon) {
  const Cells cells(set, horizon);
  const double limit = std::pow(horizon * (1 + 1e-9), 2);
  std::vector<std::uint64_t> key(set.size());
  std::vector<std::int32_t> family(set.size(), -1);
  Vector3 origin;
  for (std::size_t k = 0; k < 3; ++k)
    origin[k] = *std::min_element(set.position[k].begin(), set.position[k].end());
  for (std::size_t i = 0; i < set.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      key[i] |= spread(static_cast<std::uint64_t>((set.position[k][i] - origin[k]) / set.spacing)) << k;
    cells.for_each_near(i, [&](std::size_t j) { family[i] += squared_distance(set, i, j) <= limit ? 1 : 0; });
  }
  std::vector<std::size_t> order(set.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key[a] < key[b]; });
  constexpr std::size_t run = 256;
  for (std::size_t begin = 0; begin < order.size(); begin += run) {
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
    std::stable_sort(first, order.begin() + static_cast<std::ptrdiff_t>(std::min(begin + run, order.size())),
                     [&](std::size_t a, std::size_t b) { return family[a] < family[b]; });
  }
  return order;
}

}  // namespace rhexis::peridynamics
