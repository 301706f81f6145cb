// SPDX-License-Identifier: BSD-3-Clause
// Vector versions digit for digit: tables against their scalar, random lanes against Random123.
#include "hemodynamics/steady/tree/lanes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rhexis::hemodynamics {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

TEST(TableLanes, GiveTheSameDigits) {
  const auto function = [](long double x) { return std::max(x, 0.3L) / x; };
  const network::IntervalTable table(function, 1e-3, 1.0, {0.3});
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> argument(1e-3, 1.0);
  const lanes::Reals d;
  for (int i = 0; i < 2000; ++i) {
    alignas(64) double x[lanes::width], y[lanes::width];
    for (double& value : x) value = argument(random);
    hn::Store(lanes::value_of(table, hn::Load(d, x)), d, y);
    for (std::size_t k = 0; k < lanes::width; ++k) EXPECT_EQ(y[k], table(x[k]));
  }
}

TEST(RandomLanes, AreThoseOfRandom123) {
  const lanes::Words w;
  const lanes::Reals d;
  for (const std::uint64_t first : {0ULL, 64ULL, (1ULL << 39) + 992}) {
    for (std::uint64_t block = first; block < first + 64; block += 32) {
      for (std::size_t s = 0; s < 8; s += lanes::width) {
        const auto words = lanes::philox(hn::Iota(w, network::counter_of(block) + s),
                                         network::Stream::lengths, 0xfedcba9876543210u);
        for (std::size_t k = 0; k < 4; ++k) {
          alignas(64) std::uint64_t bits[lanes::width];
          alignas(64) double share[lanes::width], sign[lanes::width];
          hn::Store(words.word[k], w, bits);
          hn::Store(lanes::even_share(words.word[k]), d, share);
          hn::Store(lanes::signed_by_coin(words.word[k], hn::Set(d, 2.0)), d, sign);
          for (std::size_t i = 0; i < lanes::width; ++i) {
            const std::uint32_t expected =
                network::draw(0xfedcba9876543210u, network::Stream::lengths, block + 8 * k + s + i);
            EXPECT_EQ(bits[i], expected);
            EXPECT_EQ(share[i], network::even_share(expected));
            EXPECT_EQ(sign[i], network::coin(expected) ? -2.0 : 2.0);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace rhexis::hemodynamics
