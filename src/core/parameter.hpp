/// One declaration per input key, made beside the physics that uses it; the reader, the checks, `rhexis keys`
/// and the record of a run all work from it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace rhexis {

/// Allowed values, in SI units; an open end excludes the bound itself.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
  bool upper_open = false;

  bool contains(double v) const {
    return (lower_open ? v > lower : v >= lower) && (upper_open ? v < upper : v <= upper);
  }
  static Range any() { return {}; }
  static Range positive() { return {.lower = 0, .lower_open = true}; }
  static Range not_negative() { return {.lower = 0}; }
  static Range between(double lower, double upper) { return {.lower = lower, .upper = upper}; }
  static Range at_least(double lower) { return {.lower = lower}; }
};

/// A point of a curve read from input, e.g. a pressure at a time, in SI units.
using CurvePoint = std::pair<double, double>;

/// Where the value goes. optional<double>: the text "auto" leaves it empty.
using ParameterTarget =
    std::variant<double*, std::optional<double>*, std::int64_t*, std::optional<std::int64_t>*, bool*,
                 std::string*, std::vector<std::string>*, std::vector<double>*, std::vector<CurvePoint>*>;

/// Another key, and the values of it that are meant, as a user would write them in TOML; none: any
/// that is given.
struct Condition {
  std::string key = {};
  std::vector<std::string> values = {};
};

struct Parameter {
  std::string key;         ///< "section.name", e.g. "vessel.inner_radius"
  ParameterTarget target;  ///< typed home of the value, in SI units
  std::string unit;  ///< "m", "Pa", "s", ...; "1" for a plain number; for a curve "s, Pa"; empty for text
  std::optional<std::string>
      default_text;         ///< as a user would write it in TOML, e.g. "\"1.5 mm\"" or "0.25"; none: required
  std::string meaning;      ///< one sentence
  std::string source = {};  ///< paper and equation or table, where there is one
  Range range = {};         ///< of each number
  std::vector<std::string> choices = {};  ///< allowed words of a text; empty: any
  /// Of a section that may stand any number of times, [[section]]: `target` is a vector<double>* that gets
  /// one number from each.
  bool repeated = false;
  std::vector<Condition> only_with = {};  ///< the key has no effect unless one of them holds; none: always
};

using ParameterList = std::vector<Parameter>;

/// `parameter`, which has no effect unless one of `conditions` holds.
inline Parameter only_with_one_of(std::vector<Condition> conditions, Parameter parameter) {
  parameter.only_with = std::move(conditions);
  return parameter;
}

inline Parameter only_with(Condition condition, Parameter parameter) {
  return only_with_one_of({std::move(condition)}, std::move(parameter));
}

}  // namespace rhexis
