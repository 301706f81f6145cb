// SPDX-License-Identifier: BSD-3-Clause
/// Pieces of a text as readers of files meet them: blanks around words, and numbers.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>

namespace rhexis {

inline constexpr std::string_view blanks = " \t\r\n";

/// `text` without the blanks at its ends.
inline std::string_view without_blanks(std::string_view text) {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// The decimal number that is all of `text`, with or without a sign; none where that is no finite number.
inline std::optional<double> finite_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  return is_number ? std::optional(value) : std::nullopt;
}

}  // namespace rhexis
