// SPDX-License-Identifier: BSD-3-Clause
/// Quantities written by people, such as "1.5 mm" or "238 kPa", turned into SI numbers by UDUNITS-2.
#pragma once

#include <string>
#include <string_view>

namespace rhexis::input {

/// The value of `text` in the SI unit `unit` ("m", "Pa", "kg/m3", "1", ...): to_si("1.5 mm", "m") is 0.0015.
/// A plain number ("1" or empty) needs no unit in the text; "25 %" works too.
/// @throws InputError where the text is not a finite number with a unit of that dimension; the message says
/// what
///         is wrong and gives an example, and leaves out where the text came from.
/// @throws std::logic_error where `unit` itself is unknown: a declaration is wrong, not the input.
/// @throws RunError where the database of UDUNITS-2 is not installed.
double to_si(std::string_view text, std::string_view unit);

/// Whether `unit` stands for a number without a dimension.
inline bool is_plain(std::string_view unit) {
  return unit.empty() || unit == "1";
}

/// "0.0015 m", or "0.25" for a plain number.
std::string with_unit(double value, std::string_view unit);

/// `value`, in the SI unit `unit`, as a user would write it in the unit `shown_in`: "1.5 mm". As many digits
/// as it takes for to_si to give exactly `value`.
std::string written_in(std::string_view shown_in, double value, std::string_view unit);

/// What a unit measures, with its article: "a pressure" for "Pa"; "a value in m5" where it has no name here.
std::string measured_by(std::string_view unit);

/// A quantity as a user would write it, without quotes: "1.5 mm" for "m", "0.25" for "1".
std::string example_quantity(std::string_view unit);

}  // namespace rhexis::input
