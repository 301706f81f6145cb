// SPDX-License-Identifier: BSD-3-Clause
#include "input/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "core/error.hpp"
#include "core/scanning.hpp"

namespace rhexis::input {
namespace {

struct Release {
  void operator()(ut_system* s) const { ut_free_system(s); }
  void operator()(ut_unit* u) const { ut_free(u); }
  void operator()(cv_converter* c) const { cv_free(c); }
};
using System = std::unique_ptr<ut_system, Release>;
using Unit = std::unique_ptr<ut_unit, Release>;
using Converter = std::unique_ptr<cv_converter, Release>;

/// A kind of quantity, for messages: its name and how people write it.
struct Kind {
  std::string_view unit;
  std::string_view noun;
  std::string_view number;     ///< a sensible one in the first of the usual units
  std::string_view usual;      ///< unit people write
  std::string_view usual_too;  ///< another one, where there is one
};

constexpr std::array kinds{
    Kind{"m", "a length", "1.5", "mm", "um"},
    Kind{"s", "a time", "500", "ns", "ms"},
    Kind{"rad", "an angle", "30", "deg", "rad"},
    Kind{"kg", "a mass", "1", "g", "kg"},
    Kind{"K", "a temperature", "37", "degC", "K"},
    Kind{"Pa", "a pressure", "238", "kPa", "mmHg"},
    Kind{"kg/m3", "a density", "1.06", "g/cm3", "kg/m3"},
    Kind{"m2", "an area", "1", "mm2", ""},
    Kind{"m3", "a volume", "5", "mL", "mm3"},
    Kind{"m/s", "a speed", "10", "cm/s", "m/s"},
    Kind{"m/s2", "an acceleration", "9.81", "m/s2", ""},
    Kind{"m3/s", "a flow rate", "5", "L/min", "mL/s"},
    Kind{"Pa s", "a viscosity", "3.5", "mPa s", "cP"},
    Kind{"Pa s/m3", "a flow resistance", "1", "Pa s/m3", "mmHg min/L"},
    Kind{"m3/(Pa s)", "a flow conductance", "1", "m3/(Pa s)", ""},
    Kind{"Pa/s", "a pressure rate", "100", "kPa/ms", ""},
    Kind{"Pa/m", "a pressure gradient", "1", "kPa/m", ""},
    Kind{"1/s", "a rate", "70", "1/min", "Hz"},
    Kind{"1/m3", "a number density", "600", "1/mm3", ""},
    Kind{"N", "a force", "1", "mN", "dyn"},
    Kind{"N/m", "an energy per area", "100", "J/m2", "N/m"},
    Kind{"N/m3", "a force per volume", "1", "N/m3", ""},
    Kind{"J", "an energy", "1", "mJ", "J"},
    Kind{"W", "a power", "1", "W", "mW"},
};

/// UDUNITS's database, read once, without UDUNITS's own remarks on standard error.
const ut_system* unit_system() {
  static const System system = [] {
    ut_set_error_message_handler(ut_ignore);
    System read{ut_read_xml(nullptr)};
    if (!read)
      throw RunError(
          "cannot read the UDUNITS-2 unit database (Debian: libudunits2-data; or set UDUNITS2_XML_PATH)");
    // People write these; UDUNITS knows them by name only.
    ut_map_symbol_to_unit("P", UT_ASCII, Unit{ut_get_unit_by_name(read.get(), "poise")}.get());
    ut_map_symbol_to_unit("dyn", UT_ASCII, Unit{ut_get_unit_by_name(read.get(), "dyne")}.get());
    ut_map_symbol_to_unit("deg", UT_ASCII, Unit{ut_get_unit_by_name(read.get(), "degree")}.get());
    return read;
  }();
  return system.get();
}

Unit parse_unit(std::string_view text) {
  if (text == "g0") text = "gravity";  // to UDUNITS it is a gram to the power of 0
  return Unit{ut_parse(unit_system(), std::string(text).c_str(), UT_UTF8)};
}

/// Same dimension, not only convertible: UDUNITS also converts a frequency to a time by taking the
/// reciprocal.
bool same_dimension(const ut_unit* a, const ut_unit* b) {
  if (!ut_are_convertible(a, b)) return false;
  const Unit ratio{ut_divide(a, b)};
  return ratio && ut_is_dimensionless(ratio.get());
}

const Kind* kind_of(const ut_unit* unit) {
  for (const Kind& kind : kinds)
    if (same_dimension(unit, parse_unit(kind.unit).get())) return &kind;
  return nullptr;
}

const Kind* kind_of(std::string_view unit) {
  const Unit parsed = parse_unit(unit);
  return parsed ? kind_of(parsed.get()) : nullptr;
}

std::string example_with(std::string_view number, std::string_view unit) {
  if (is_plain(unit)) return "for example 0.25 or \"25 %\"";
  const Kind* kind = kind_of(unit);
  if (!kind) return fmt::format("for example \"{} {}\"", number, unit);
  // A number that was meant is most often one of SI.
  std::string text = fmt::format("for example \"{} {}\"", number, kind->unit);
  for (const std::string_view usual : {kind->usual, kind->usual_too}) {
    if (!usual.empty() && usual != kind->unit) text += fmt::format(" or \"{} {}\"", number, usual);
  }
  return text;
}

/// UDUNITS multiplies every number it meets, so that "1 000 mm" would be 0 and "5 mm 3", "5 mm*3" be 15 mm.
/// Apart from exponents, which follow their unit, ^ or **, only the 1 of "1/s" is let through.
bool has_second_number(std::string_view unit) {
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const auto before = unit.substr(0, i);
    if (i > 0 &&
        (before.ends_with("**") || (!std::isspace(static_cast<unsigned char>(before.back())) &&
                                    std::string_view("*./()").find(before.back()) == std::string_view::npos)))
      continue;
    const auto token = unit.substr(i);
    const auto digit = token.find_first_not_of("+-.");
    const bool number =
        digit != std::string_view::npos && std::isdigit(static_cast<unsigned char>(token[digit]));
    if (number && !token.starts_with("1/")) return true;
  }
  return false;
}

struct Written {
  double number;
  std::string_view digits;
  std::string_view unit;
};

Written split(std::string_view text, std::string_view expected) {
  // UDUNITS would stop reading there and miss the rest.
  if (text.find('\0') != std::string_view::npos) throw InputError("holds a NUL character");
  text = without_blanks(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc::invalid_argument)
    throw InputError(fmt::format("does not begin with a number; write {}, for example \"{}\"",
                                 measured_by(expected), example_quantity(expected)));
  const auto digits = text.substr(0, static_cast<std::size_t>(end - text.data()));
  if (error == std::errc::result_out_of_range || !std::isfinite(number))
    throw InputError(fmt::format("'{}' is not a finite number", digits));
  const auto unit = without_blanks(text.substr(digits.size()));
  if (unit.starts_with(',')) throw InputError("a decimal comma; write the number with a point");
  if (has_second_number(unit)) throw InputError("has more than one number; write one number and its unit");
  return {number, digits, unit};
}

/// Multiplies or divides by a whole number where the factor is one, so that "100 um" is exactly 1e-4 m.
double converted(double value, cv_converter* converter) {
  const double factor = cv_convert_double(converter, 1.0);
  if (cv_convert_double(converter, 0.0) != 0.0) return cv_convert_double(converter, value);
  const auto is_whole = [](double x) {
    return std::abs(x - std::round(x)) <= 1e-12 * x && std::round(x) >= 1;
  };
  if (is_whole(factor)) return value * std::round(factor);
  if (is_whole(1 / factor)) return value / std::round(1 / factor);
  return value * factor;
}

}  // namespace

double to_si(std::string_view text, std::string_view unit) {
  const Unit expected = parse_unit(is_plain(unit) ? "1" : unit);
  if (!expected) throw std::logic_error(fmt::format("'{}' is not a unit", unit));
  const Written written = split(text, unit);
  if (written.unit.empty() && is_plain(unit)) return written.number;
  if (written.unit.empty())
    throw InputError("a unit is missing; write " + example_with(written.digits, unit));
  const Unit given = parse_unit(written.unit);
  if (!given)
    throw InputError(
        fmt::format("'{}' is not a known unit; write {}", written.unit, example_with(written.digits, unit)));
  if (!same_dimension(given.get(), expected.get())) {
    // Not every number without dimension is an angle.
    const Kind* kind = ut_is_dimensionless(given.get()) ? nullptr : kind_of(given.get());
    throw InputError(
        fmt::format("'{}' {}, but {} is expected, {}", written.unit,
                    kind ? fmt::format("measures {}", kind->noun) : "is a unit of something else",
                    measured_by(unit), example_with(written.digits, unit)));
  }
  const double value =
      converted(written.number, Converter{ut_get_converter(given.get(), expected.get())}.get());
  if (!std::isfinite(value)) throw InputError(fmt::format("is too large a number in {}", unit));
  return value;
}

std::string with_unit(double value, std::string_view unit) {
  return is_plain(unit) ? fmt::format("{:.10g}", value) : fmt::format("{:.10g} {}", value, unit);
}

std::string written_in(std::string_view shown_in, double value, std::string_view unit) {
  const double size = to_si(fmt::format("1 {}", shown_in), unit);
  std::string text;
  for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    const double rounded = std::stod(fmt::format("{:.{}e}", value / size, digits - 1));
    text = fmt::format("{} {}", rounded, shown_in);
    if (to_si(text, unit) == value) break;
  }
  return text;
}

std::string measured_by(std::string_view unit) {
  if (is_plain(unit)) return "a plain number";
  const Kind* kind = kind_of(unit);
  return kind ? std::string(kind->noun) : fmt::format("a value in {}", unit);
}

std::string example_quantity(std::string_view unit) {
  if (is_plain(unit)) return "0.25";
  const Kind* kind = kind_of(unit);
  return kind ? fmt::format("{} {}", kind->number, kind->usual) : fmt::format("1 {}", unit);
}

}  // namespace rhexis::input
