// SPDX-License-Identifier: BSD-3-Clause
/// Checksums of data that ranks write and read in pieces, each divided as it likes.
///
/// The checksum of values x_i is the sum over i of mix(bits of x_i + key + i c), modulo 2^64. Integer sums do
/// not depend on order, so every partition gives the same; `mix` is a bijection, so one wrong value is always
/// found, and any other damage is missed once in 2^64. The key is made of the data set's name, so that data
/// sets that change places are found too. HDF5's own checksums (Fletcher's filter) need chunks, which
/// parallel collective writes to contiguous data sets do not go with.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/id_ranges.hpp"

namespace rhexis::output {

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014, doi:10.1145/2660193.2660195): every bit of the
/// result depends on every bit of `x`.
constexpr std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Mixes one value: 2^64 divided by the golden ratio, odd, keeps the numbers of neighbours far apart.
constexpr std::uint64_t checksum_term(std::uint64_t key, std::uint64_t index, std::uint64_t bits) {
  return mix(bits + key + index * 0x9e3779b97f4a7c15u);
}

/// The checksum of a text, byte by byte; also the key of the data set of that name.
constexpr std::uint64_t checksum(std::string_view text, std::uint64_t key = 0) {
  std::uint64_t sum = mix(text.size());
  for (std::size_t i = 0; i < text.size(); ++i)
    sum += checksum_term(key, i, static_cast<unsigned char>(text[i]));
  return sum;
}

inline std::uint64_t bits_of(double value) {
  return std::bit_cast<std::uint64_t>(value);
}
inline std::uint64_t bits_of(std::uint16_t value) {
  return value;
}

/// What a rank's part, with its values row after row, adds to the checksum of the table. Local.
template <class Value>
std::uint64_t checksum(const TablePart& part, std::span<const Value> values, std::uint64_t key) {
  std::uint64_t sum = 0;
  const Value* value = values.data();
  for (const IdRange& range : part.rows.ranges) {
    for (std::int64_t row = range.first; row < range.first + range.count; ++row) {
      auto index = static_cast<std::uint64_t>(row * part.width + part.first);
      for (std::int64_t c = 0; c < part.count; ++c) sum += checksum_term(key, index++, bits_of(*value++));
    }
  }
  return sum;
}

}  // namespace rhexis::output
