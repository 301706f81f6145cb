// SPDX-License-Identifier: BSD-3-Clause
#include "bench/bond_arithmetic.hpp"

#include <hwy/aligned_allocator.h>

#include <algorithm>

#include "bench/peak.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/laws/pmb.hpp"

namespace rhexis::bench {
namespace {

using namespace peridynamics;

constexpr std::size_t family = 32;  ///< bonds, of one particle and its partners, which lie side by side

/// Adds the bonds of one vector of rows, as detail::add_run does with its `both`, but to partners' sums that
/// are registers: `rounds` times the family.
template <class D, class Real>
HWY_INLINE detail::Sums<D> add_bonds(D d, const BlockView<Real>& block, int rounds) {
  const Pmb law;
  const detail::Ends<false, D, Real> ends(block, 0);
  const detail::BreakingTest<false, D, Real> test(block, 0);
  constexpr std::size_t at_once = 4;
  const detail::Sums<D> nothing{Real{0}, Real{0}, Real{0}, Real{0}};
  detail::Sums<D> f = nothing, other[at_once] = {nothing, nothing, nothing, nothing};
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t b = 0; b < family; b += at_once) {
      for (std::size_t i = 0; i < at_once; ++i) {
        const BondConstants<Real>& bond = block.bonds[b + i];
        std::uint16_t& word = block.intact[b + i];
        const auto [y_x, y_y, y_z, t] = ends.deformed(bond);
        detail::clear(d, test.fails(bond, t), 0, word);
        const auto k = where(detail::lanes_of(d, word, 0), law.force_factor(t) * bond.weight);
        f.x = multiply_add(k, y_x, f.x);
        f.y = multiply_add(k, y_y, f.y);
        f.z = multiply_add(k, y_z, f.z);
        other[i].x = negative_multiply_add(k, y_x, other[i].x);
        other[i].y = negative_multiply_add(k, y_y, other[i].y);
        other[i].z = negative_multiply_add(k, y_z, other[i].z);
      }
    }
  }
  for (const auto& o : other) {
    f.x = f.x + o.x;
    f.y = f.y + o.y;
    f.z = f.z + o.z;
  }
  return f;
}

}  // namespace

template <class Real>
double bond_arithmetic_rate(int threads) {
  constexpr int rounds = 1500;
  return best_rate(threads, [](int) {
    const hn::CappedTag<Real, parallel::block_rows> d;
    const std::size_t lanes = hn::Lanes(d), past = (family + 1) * lanes;
    const auto u = hwy::AllocateAligned<Real>(past);
    for (std::size_t i = 0; i < past; ++i) u[i] = static_cast<Real>(1e-3 * static_cast<double>(i % lanes));
    BondConstants<Real> bonds[family];
    for (std::size_t b = 0; b < family; ++b) {
      const auto xi = static_cast<Real>(1 + 0.01 * static_cast<double>(b));
      bonds[b] = {.xi = {xi, xi, xi},
                  .inverse_length2 = 1 / (3 * xi * xi),
                  .twice_xi = {2 / (3 * xi), 2 / (3 * xi), 2 / (3 * xi)},
                  .weight = Real{1},
                  .volume = Real{1},
                  .energy_weight = Real{1},
                  .offset = static_cast<std::int32_t>((b + 1) * lanes)};
    }
    std::uint16_t intact[family];
    std::fill_n(intact, family, std::uint16_t{0xFFFF});
    const BlockView<Real> block{
        .u = {u.get(), u.get(), u.get()}, .bonds = bonds, .intact = intact, .breaking_t = Real{1}};
    const auto f = add_bonds(d, block, rounds);
    [[maybe_unused]] const volatile Real needed = hn::GetLane((f.x + (f.y + f.z)).vector);
    return static_cast<double>(rounds) * static_cast<double>(family * lanes);
  });
}

template double bond_arithmetic_rate<float>(int);
template double bond_arithmetic_rate<double>(int);

}  // namespace rhexis::bench
