// SPDX-License-Identifier: BSD-3-Clause
/// Random numbers of the implicit trees: a function of (seed, stream, number), so that a vessel's draw does
/// not depend on who asks, in which order, or on how many ranks.
///
/// Philox 4x32-7 (Salmon et al. 2011, doi:10.1145/2063384.2063405; 7 rounds are the fewest that pass all of
/// its tests) gives four words of 32 bits at a time; draws that lie 8 apart share one evaluation: number n is
/// word (n >> 3) & 3 of counter ((n >> 5) << 3) | (n & 7). Vector code thus makes 32 consecutive draws from 8
/// counters (hemodynamics/random_lanes.hpp).
#pragma once

#include <Random123/philox.h>

#include <cstdint>

namespace rhexis::network {

constexpr int rounds = 7;

/// What is drawn. Walls: of arteries, + 1 of veins.
enum class Stream : std::uint32_t {
  splits = 0,
  lengths = 1,
  wall_strength = 2,
  wall_thickness = 4,
  wall_stiffness = 6
};

constexpr std::uint64_t counter_of(std::uint64_t number) {
  return ((number >> 5) << 3) | (number & 7);
}
constexpr std::uint32_t word_of(std::uint64_t number) {
  return static_cast<std::uint32_t>((number >> 3) & 3);
}

/// 32 random bits.
inline std::uint32_t draw(std::uint64_t seed, Stream stream, std::uint64_t number) {
  const std::uint64_t counter = counter_of(number);
  const r123::Philox4x32::ctr_type words = r123::Philox4x32_R<rounds>()(
      {{static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32),
        static_cast<std::uint32_t>(stream), 0}},
      {{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}});
  return words[word_of(number)];
}

/// The middle of one of 2^31 even intervals of [0, 1), from the lower 31 bits.
constexpr double even_share(std::uint32_t bits) {
  return ((bits & 0x7fffffffu) + 0.5) * 0x1p-31;
}

/// Whether the top bit is set: a coin independent of `even_share`.
constexpr bool coin(std::uint32_t bits) {
  return (bits >> 31) != 0;
}

}  // namespace rhexis::network
