#include "bench/bond_arithmetic.hpp"

#include <hwy/aligned_allocator.h>

#include <algorithm>

#include "bench/peak.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/laws/pmb.hpp"

namespace rhexis::bench {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace peridynamics;

constexpr std::size_t family = 32;  ///< bonds, of one particle and its partners, which lie side by side

/// Adds the bonds of one vector of rows, as detail::add_run does with its `both`, but to partners' sums that
/// are registers: `rounds` times the family.
template <class D, class Real>
HWY_INLINE detail::Sums<D> add_bonds(D d, const BlockView<Real>& block, int rounds) {
  const Pmb law;
  const detail::Ends<false, D, Real> ends(d, block, 0);
  const detail::BreakingTest<false, D, Real> test(d, block, 0);
  constexpr std::size_t at_once = 4;
  detail::Sums<D> f{hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)}, other[at_once];
  for (auto& o : other) o = f;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t b = 0; b < family; b += at_once) {
      for (std::size_t i = 0; i < at_once; ++i) {
        const BondConstants<Real>& bond = block.bonds[b + i];
        std::uint16_t& word = block.intact[b + i];
        const auto [y_x, y_y, y_z, t] = ends.deformed(d, bond);
        detail::clear(d, test.fails(d, law, bond, t), 0, word);
        const auto k = hn::IfThenElseZero(detail::lanes_of(d, word, 0),
                                          hn::Mul(law.force_factor(d, t), hn::Set(d, bond.weight)));
        f.x = hn::MulAdd(k, y_x, f.x);
        f.y = hn::MulAdd(k, y_y, f.y);
        f.z = hn::MulAdd(k, y_z, f.z);
        other[i].x = hn::NegMulAdd(k, y_x, other[i].x);
        other[i].y = hn::NegMulAdd(k, y_y, other[i].y);
        other[i].z = hn::NegMulAdd(k, y_z, other[i].z);
      }
    }
  }
  for (const auto& o : other) {
    f.x = hn::Add(f.x, o.x);
    f.y = hn::Add(f.y, o.y);
    f.z = hn::Add(f.z, o.z);
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
    [[maybe_unused]] const volatile Real needed = hn::GetLane(hn::Add(f.x, hn::Add(f.y, f.z)));
    return static_cast<double>(rounds) * static_cast<double>(family * lanes);
  });
}

template double bond_arithmetic_rate<float>(int);
template double bond_arithmetic_rate<double>(int);

}  // namespace rhexis::bench
