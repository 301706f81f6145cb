// SPDX-License-Identifier: BSD-3-Clause
/// Text from files and command lines, made fit for a terminal and a line of a log.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rhexis {

/// Bytes of the UTF-8 character that `text` begins with; 0 where it begins with none.
inline std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  // Longer than need be, a half of a UTF-16 pair, or beyond U+10FFFF.
  const unsigned second = byte(1);
  const bool no_character = (lead == 0xE0 && second < 0xA0) || (lead == 0xED && second >= 0xA0) ||
                            (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second >= 0x90);
  return no_character ? 0 : length;
}

/// `text` as a terminal can show it without being steered by it: control characters other than line breaks
/// and tabs, and bytes that are not UTF-8, as "\x1b". What is longer than `longest` bytes loses its middle.
inline std::string printable(std::string_view text, std::size_t longest = std::string_view::npos) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto first = static_cast<unsigned char>(text[0]);
    const bool c1 = length == 2 && first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0;
    const bool control = (first < 0x20 && first != '\n' && first != '\t') || first == 0x7F || c1;
    if (length > 0 && !control) {
      result += text.substr(0, length);
    } else {
      for (const char c : text.substr(0, length > 0 ? length : 1)) {
        constexpr char digits[] = "0123456789abcdef";
        const auto byte = static_cast<unsigned char>(c);
        result += {'\\', 'x', digits[byte / 16], digits[byte % 16]};
      }
    }
    text.remove_prefix(length > 0 ? length : 1);
  }
  if (result.size() <= longest) return result;
  const auto inside = [&](std::size_t i) { return (static_cast<unsigned char>(result[i]) & 0xC0U) == 0x80U; };
  std::size_t begin = longest / 2, end = result.size() - longest / 2;
  while (inside(begin)) --begin;
  while (inside(end)) ++end;
  return result.substr(0, begin) + " ... " + result.substr(end);
}

}  // namespace rhexis
