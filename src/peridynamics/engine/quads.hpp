// SPDX-License-Identifier: BSD-3-Clause
/// Four numbers of a particle, or three of a bond, side by side: a vector of particles with any numbers is
/// then read by one load each and a few shuffles, where one gather for each of the numbers would take three
/// times as long.
#pragma once

#include <cstddef>
#include <cstdint>

#include "peridynamics/laws/numbers.hpp"

namespace rhexis::peridynamics {

/// Numbers of a particle in arrays of quads.
inline constexpr std::size_t quad = 4;

namespace detail {

#if HWY_HAVE_SCALABLE || HWY_TARGET == HWY_SCALAR
inline constexpr bool has_blocks = false;
#else
inline constexpr bool has_blocks = true;
#endif

/// The vector whose 128-bit blocks begin at values[offset[0]], values[offset[4]] ...
template <class D, class T>
HWY_INLINE hn::Vec<D> blocks_at(D d, const T* values, const std::int32_t* offset) {
  constexpr std::size_t lanes = hn::MaxLanes(D());
  if constexpr (lanes <= 4) {
    return hn::LoadU(d, values + *offset);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, blocks_at(half, values, offset + lanes / 2), blocks_at(half, values, offset));
  }
}

/// Writes three numbers of each of the 128-bit blocks of four vectors, the first blocks of all first.
template <class D, class Real>
HWY_INLINE void store_blocks(D d, const hn::Vec<D> (&v)[4], Real* out, bool last) {
  constexpr std::size_t lanes = hn::MaxLanes(D());
  if constexpr (lanes <= 4) {
    for (std::size_t r = 0; r < 3; ++r) hn::StoreU(v[r], d, out + 3 * r);
    if (last) {
      alignas(16) Real rest[4];
      hn::Store(v[3], d, rest);
      for (std::size_t k = 0; k < 3; ++k) out[9 + k] = rest[k];
    } else {
      hn::StoreU(v[3], d, out + 9);
    }
  } else {
    const hn::Half<D> half;
    const auto lower = [&](std::size_t r) { return hn::LowerHalf(half, v[r]); };
    const auto upper = [&](std::size_t r) { return hn::UpperHalf(half, v[r]); };
    store_blocks(half, {lower(0), lower(1), lower(2), lower(3)}, out, false);
    store_blocks(half, {upper(0), upper(1), upper(2), upper(3)}, out + 3 * lanes / 2, last);
  }
}

}  // namespace detail

/// The three numbers at values + offset[lane] of each lane. One number more is read than is used.
template <class D, class T>
HWY_INLINE void load_triples(D d, const T* values, const std::int32_t* offset, hn::Vec<D> (&out)[3]) {
  if constexpr (sizeof(T) == 4 && detail::has_blocks) {
    const hn::RepartitionToWide<hn::RebindToUnsigned<D>> pairs;
    const hn::RebindToUnsigned<D> bits;
    const auto at = [&](std::size_t lane) { return detail::blocks_at(d, values, offset + lane); };
    const auto v0 = at(0), v1 = at(1), v2 = at(2), v3 = at(3);
    const auto as_pairs = [&](auto v) { return hn::BitCast(pairs, hn::BitCast(bits, v)); };
    const auto as_numbers = [&](auto v) { return hn::BitCast(d, hn::BitCast(bits, v)); };
    const auto xy01 = as_pairs(hn::InterleaveLower(d, v0, v1)),
               xy23 = as_pairs(hn::InterleaveLower(d, v2, v3));
    const auto zw01 = as_pairs(hn::InterleaveUpper(d, v0, v1)),
               zw23 = as_pairs(hn::InterleaveUpper(d, v2, v3));
    out[0] = as_numbers(hn::InterleaveLower(pairs, xy01, xy23));
    out[1] = as_numbers(hn::InterleaveUpper(pairs, xy01, xy23));
    out[2] = as_numbers(hn::InterleaveLower(pairs, zw01, zw23));
  } else {
    alignas(64) T column[3][HWY_MAX_BYTES / sizeof(T)];
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      for (std::size_t k = 0; k < 3; ++k)
        column[k][lane] = values[static_cast<std::size_t>(offset[lane]) + k];
    }
    for (std::size_t k = 0; k < 3; ++k) out[k] = hn::Load(d, column[k]);
  }
}

/// Writes x, y, z of the lanes one after the other. Unless it is `last`, one number more is overwritten.
template <class D, class Real>
HWY_INLINE void store_triples(D d, const Lanes<D> (&v)[3], Real* out, bool last) {
  if constexpr (sizeof(Real) == 4 && detail::has_blocks) {
    const hn::RepartitionToWide<hn::RebindToUnsigned<D>> pairs;
    const hn::RebindToUnsigned<D> bits;
    const auto as_pairs = [&](auto a) { return hn::BitCast(pairs, hn::BitCast(bits, a)); };
    const auto as_numbers = [&](auto a) { return hn::BitCast(d, hn::BitCast(bits, a)); };
    const auto x = v[0].vector, y = v[1].vector, z = v[2].vector;
    const auto xy01 = as_pairs(hn::InterleaveLower(d, x, y)), zz01 = as_pairs(hn::InterleaveLower(d, z, z));
    const auto xy23 = as_pairs(hn::InterleaveUpper(d, x, y)), zz23 = as_pairs(hn::InterleaveUpper(d, z, z));
    detail::store_blocks(d,
                         {as_numbers(hn::InterleaveLower(pairs, xy01, zz01)),
                          as_numbers(hn::InterleaveUpper(pairs, xy01, zz01)),
                          as_numbers(hn::InterleaveLower(pairs, xy23, zz23)),
                          as_numbers(hn::InterleaveUpper(pairs, xy23, zz23))},
                         out, last);
  } else {
    alignas(64) Real column[3][HWY_MAX_BYTES / sizeof(Real)];
    for (std::size_t k = 0; k < 3; ++k) hn::Store(v[k].vector, d, column[k]);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      for (std::size_t k = 0; k < 3; ++k) out[3 * lane + k] = column[k][lane];
    }
  }
}

}  // namespace rhexis::peridynamics
