// SPDX-License-Identifier: BSD-3-Clause
/// Texts as spreadsheets and editors of any system store them, turned into what the readers here take: UTF-8
/// without a byte order mark, lines that end in a line feed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/printable.hpp"

namespace rhexis {

/// Appends the UTF-8 bytes of a Unicode character.
inline void append_utf8(std::string& text, std::uint32_t character) {
  const auto byte = [](std::uint32_t value) { return static_cast<char>(static_cast<unsigned char>(value)); };
  const auto continuation = [&](unsigned shift) { return byte(0x80U | ((character >> shift) & 0x3FU)); };
  if (character < 0x80) {
    text += byte(character);
  } else if (character < 0x800) {
    text += {byte(0xC0U | (character >> 6U)), continuation(0)};
  } else if (character < 0x10000) {
    text += {byte(0xE0U | (character >> 12U)), continuation(6), continuation(0)};
  } else {
    text += {byte(0xF0U | (character >> 18U)), continuation(12), continuation(6), continuation(0)};
  }
}

/// UTF-16, two bytes a unit of which the first is the high one if `big_endian`, as UTF-8. A half of a pair
/// becomes the replacement character U+FFFD.
inline std::string utf8_of_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]),
               second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  const auto in = [](std::uint32_t value, std::uint32_t first) {
    return value >= first && value < first + 0x400;
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const std::uint32_t value = unit(i);
    if (in(value, 0xD800) && i + 3 < bytes.size() && in(unit(i + 2), 0xDC00)) {
      append_utf8(text, 0x10000 + ((value - 0xD800) << 10U) + (unit(i + 2) - 0xDC00));
      i += 2;
    } else {
      append_utf8(text, in(value, 0xD800) || in(value, 0xDC00) ? 0xFFFD : value);
    }
  }
  return text;
}

inline bool is_utf8(std::string_view text) {
  const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  while (true) {
    text.remove_prefix(
        static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_ascii) - text.begin()));
    if (text.empty()) return true;
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
}

/// Bytes that each are the number of a Unicode character, as UTF-8.
inline std::string utf8_of_latin1(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size());
  for (const char c : bytes) append_utf8(text, static_cast<unsigned char>(c));
  return text;
}

/// `text` without the byte order mark of UTF-8, or translated from UTF-16 where it begins with one of those,
/// or from Latin 1 (as spreadsheets write where no Unicode is asked for) where it is no UTF-8; lines that end
/// in carriage returns alone (old Macintosh) end in line feeds.
inline std::string plain_text(std::string text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    text = utf8_of_utf16(std::string_view(text).substr(2), text.front() == '\xfe');
  } else if (text.starts_with("\xef\xbb\xbf")) {
    text.erase(0, 3);
  }
  if (!is_utf8(text)) text = utf8_of_latin1(text);
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

}  // namespace rhexis
