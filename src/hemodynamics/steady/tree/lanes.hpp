// SPDX-License-Identifier: BSD-3-Clause
/// Vector versions of what the implicit trees need: random draws and interval tables, several places at once.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

#include "network/interval_table.hpp"
#include "network/tree/random_stream.hpp"

#if HWY_TARGET <= HWY_AVX3
#include <immintrin.h>
#endif

namespace rhexis::hemodynamics::lanes {

namespace hn = hwy::HWY_NAMESPACE;
using Reals = hn::CappedTag<double, 8>;
using Words = hn::RebindToUnsigned<Reals>;
using Real = hn::VFromD<Reals>;
using Word = hn::VFromD<Words>;

inline constexpr std::size_t width = hn::MaxLanes(Reals());

/// The four words of Philox 4x32-7 for a counter in each lane, as 64-bit numbers: the same as
/// network::draw's.
struct FourWords {
  Word word[4];
};

HWY_INLINE FourWords philox(Word counter, network::Stream stream, std::uint64_t seed) {
  const Words d;
  const auto low = hn::Set(d, 0xffffffffu);
  const auto m0 = hn::Set(d, 0xD2511F53u), m1 = hn::Set(d, 0xCD9E8D57u);
  auto c0 = hn::And(counter, low), c1 = hn::ShiftRight<32>(counter);
  auto c2 = hn::Set(d, static_cast<std::uint64_t>(stream)), c3 = hn::Zero(d);
  const auto k0 = static_cast<std::uint32_t>(seed), k1 = static_cast<std::uint32_t>(seed >> 32);
  const hn::Repartition<std::uint32_t, Words> d32;
  for (int round = 0; round < network::rounds; ++round) {
    const auto p0 = hn::MulEven(hn::BitCast(d32, c0), hn::BitCast(d32, m0));
    const auto p1 = hn::MulEven(hn::BitCast(d32, c2), hn::BitCast(d32, m1));
    const std::uint64_t r = static_cast<std::uint64_t>(round);
    const auto next0 = hn::Xor3(hn::ShiftRight<32>(p1), c1, hn::Set(d, (k0 + r * 0x9E3779B9u) & 0xffffffffu));
    const auto next2 = hn::Xor3(hn::ShiftRight<32>(p0), c3, hn::Set(d, (k1 + r * 0xBB67AE85u) & 0xffffffffu));
    c1 = hn::And(p1, low);
    c3 = hn::And(p0, low);
    c0 = next0;
    c2 = next2;
  }
  return {{c0, c1, c2, c3}};
}

/// out[i] of every i in [0, count) from the random word of number `first + i`: by `in_lanes` of a vector of
/// words, by `scalar` where there are few. `count`: a power of two that divides `first`; `out` aligned for
/// vectors. Four words of 8 counters serve 32 numbers.
template <class InLanes, class Scalar>
void draw_each(std::uint64_t seed, network::Stream stream, std::uint64_t first, std::size_t count,
               double* out, const InLanes& in_lanes, const Scalar& scalar) {
  const Reals d;
  const Words w;
  if (count < width) {
    for (std::size_t i = 0; i < count; ++i) out[i] = scalar(network::draw(seed, stream, first + i));
    return;
  }
  const std::size_t block = count < 32 ? count : 32;
  for (std::size_t i = 0; i < count; i += block) {
    for (std::size_t s = 0; s < (block < 32 ? block : 8); s += width) {
      const Word counter = hn::Iota(w, network::counter_of(first + i + s));
      const FourWords words = philox(counter, stream, seed);
      if (block < 32) {
        hn::Store(in_lanes(words.word[network::word_of(first + i + s)]), d, out + i + s);
        continue;
      }
      for (std::size_t k = 0; k < 4; ++k) hn::Store(in_lanes(words.word[k]), d, out + i + 8 * k + s);
    }
  }
}

/// network::even_share of the word in each lane.
HWY_INLINE Real even_share(Word bits) {
  // (bits & 0x7fffffff) as a double without a conversion: it is put into the mantissa of 2^52.
  const Reals d;
  const Words w;
  const auto whole = hn::Or(hn::And(bits, hn::Set(w, 0x7fffffffu)), hn::Set(w, 0x4330000000000000u));
  const auto number = hn::Sub(hn::BitCast(d, whole), hn::Set(d, 0x1p52));
  return hn::Mul(hn::Add(number, hn::Set(d, 0.5)), hn::Set(d, 0x1p-31));
}

/// +1 or -1 (network::coin: true is -1) with the magnitude of `value`.
HWY_INLINE Real signed_by_coin(Word bits, Real value) {
  const Reals d;
  const Words w;
  return hn::BitCast(
      d, hn::Xor(hn::BitCast(w, value), hn::ShiftLeft<32>(hn::And(bits, hn::Set(w, 0x80000000u)))));
}

#if HWY_TARGET <= HWY_AVX3
/// Row r of the result holds coefficient r of all 8 lanes: an 8 x 8 transposition, 5 times as fast as
/// gathering.
HWY_INLINE void load_rows(const double* const row[8], __m512d out[8]) {
  __m512d r[8], pair[8], quad[8];
  for (int i = 0; i < 8; ++i) r[i] = _mm512_load_pd(row[i]);
  for (int i = 0; i < 8; i += 2) {
    pair[i] = _mm512_unpacklo_pd(r[i], r[i + 1]);
    pair[i + 1] = _mm512_unpackhi_pd(r[i], r[i + 1]);
  }
  for (int odd = 0; odd < 2; ++odd) {
    quad[4 * odd] = _mm512_shuffle_f64x2(pair[odd], pair[2 + odd], 0x88);
    quad[4 * odd + 1] = _mm512_shuffle_f64x2(pair[odd], pair[2 + odd], 0xdd);
    quad[4 * odd + 2] = _mm512_shuffle_f64x2(pair[4 + odd], pair[6 + odd], 0x88);
    quad[4 * odd + 3] = _mm512_shuffle_f64x2(pair[4 + odd], pair[6 + odd], 0xdd);
  }
  for (int odd = 0; odd < 2; ++odd) {
    out[odd] = _mm512_shuffle_f64x2(quad[4 * odd], quad[4 * odd + 2], 0x88);
    out[4 + odd] = _mm512_shuffle_f64x2(quad[4 * odd], quad[4 * odd + 2], 0xdd);
    out[2 + odd] = _mm512_shuffle_f64x2(quad[4 * odd + 1], quad[4 * odd + 3], 0x88);
    out[6 + odd] = _mm512_shuffle_f64x2(quad[4 * odd + 1], quad[4 * odd + 3], 0xdd);
  }
}
#endif

/// The table's value in each lane; the same digits as its scalar operator().
HWY_INLINE Real value_of(const network::IntervalTable& table, Real argument) {
  const Reals d;
  const Words w;
  const hn::RebindToSigned<Reals> di;
  constexpr int n = network::IntervalTable::coefficients;
  const auto bits = hn::BitCast(w, argument);
  const auto row =
      hn::Sub(hn::BitCast(di, hn::ShiftRightSame(bits, table.shift())), hn::Set(di, table.first_row()));
  const auto low = hn::And(bits, hn::Set(w, (std::uint64_t{1} << table.shift()) - 1));
  const auto more = hn::BitCast(d, hn::Or(low, hn::Set(w, 0x3ff0000000000000u)));
  const double scale = static_cast<double>(std::uint64_t{2} << (52 - table.shift()));
  const auto u = hn::MulAdd(more, hn::Set(d, scale), hn::Set(d, -scale - 1));
#if HWY_TARGET <= HWY_AVX3
  static_assert(width == 8 && n == 8);
  alignas(64) std::int64_t offset[8];
  hn::Store(hn::ShiftLeft<3>(row), di, offset);
  const double* rows[8];
  for (int i = 0; i < 8; ++i) rows[i] = table.rows() + offset[i];
  __m512d c[8];
  load_rows(rows, c);
  __m512d value = c[n - 1];
  for (int i = n - 2; i >= 0; --i) value = _mm512_fmadd_pd(value, u.raw, c[i]);
  Real result{value};
#else
  const auto base = hn::ShiftLeft<3>(row);
  auto result = hn::GatherIndex(d, table.rows() + n - 1, base);
  for (int i = n - 2; i >= 0; --i) result = hn::MulAdd(result, u, hn::GatherIndex(d, table.rows() + i, base));
#endif
  if (HWY_UNLIKELY(!hn::AllFalse(d, hn::IsNaN(result)))) {
    alignas(64) double x[width], y[width];
    hn::Store(argument, d, x);
    hn::Store(result, d, y);
    for (std::size_t i = 0; i < width; ++i) {
      if (y[i] != y[i]) y[i] = table.exact(x[i]);
    }
    result = hn::Load(d, y);
  }
  return result;
}

}  // namespace rhexis::hemodynamics::lanes
