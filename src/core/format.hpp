/// Numbers as people read them, in messages.
#pragma once

#include <charconv>
#include <string>

namespace rhexis {

/// `value` with at most `digits` significant digits, e.g. "0.0015", "2.38e+05".
inline std::string text(double value, int digits = 4) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits);
  return std::string(buffer, end.ptr);
}

}  // namespace rhexis
