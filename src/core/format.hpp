// SPDX-License-Identifier: BSD-3-Clause
/// Numbers as people read them, in messages.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>

namespace rhexis {

inline constexpr double pascals_per_mmhg = 133.322387415;
/// In 1 m3/s.
inline constexpr double litres_per_minute = 6e4;

/// `value` with at most `digits` significant digits, e.g. "0.0015", "2.38e+05".
inline std::string text(double value, int digits = 4) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits);
  return std::string(buffer, end.ptr);
}

/// A quantity in SI with a metric prefix before its unit: "1.5 mm", "238 kPa", "500 ns"; "-" for nan.
inline std::string quantity(double value, const std::string& unit, int digits = 4) {
  struct Prefix {
    double factor;
    const char* name;
  };
  constexpr Prefix prefixes[] = {{1e9, "G"},  {1e6, "M"},  {1e3, "k"},  {1, ""},
                                 {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}, {1e-12, "p"}};
  if (!std::isfinite(value)) return "-";
  // Half a unit of the last digit is added, so that 0.99999 becomes 1 and not 1000 m.
  const double rounded = std::abs(value) * (1 + 0.5 * std::pow(10, -digits));
  for (const Prefix& p : prefixes) {
    if (rounded >= p.factor) return text(value / p.factor, digits) + " " + p.name + unit;
  }
  return text(value, digits) + " " + unit;
}

/// A pressure (Pa) as physicians have it: "120 mmHg".
inline std::string mmhg(double pascal, int digits = 4) {
  return text(pascal / pascals_per_mmhg, digits) + " mmHg";
}

/// A count with its digits in groups of three: "54,800".
inline std::string grouped(long long count) {
  const std::string digits = std::to_string(std::abs(count));
  std::string text = count < 0 ? "-" : "";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

/// A span of time (s) as a clock tells it: "3.1 s", "12 s", "3 min 20 s", "2 h 5 min".
inline std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  if (seconds < 10) {
    char buffer[40];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, seconds, std::chars_format::fixed, 1);
    return std::string(buffer, end.ptr) + " s";
  }
  const long long whole = std::llround(seconds);
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

}  // namespace rhexis
