// SPDX-License-Identifier: BSD-3-Clause
#include "input/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "input/description.hpp"
#include "input/units.hpp"
#include "input/wording.hpp"

namespace rhexis::input {
namespace {

constexpr double exact_in_double = 9007199254740992.0;  ///< 2^53: whole numbers up to here

std::string in_parentheses(const std::string& allowed) {
  return allowed.empty() ? "" : fmt::format(" (allowed: {})", allowed);
}

void check_range(double number, const Range& range, std::string_view unit) {
  if (range.contains(number)) return;
  const std::string bounds = describe(range, unit);
  throw InputError(is_plain(unit) ? fmt::format("must be {}", bounds)
                                  : fmt::format("must be {}; this is {}", bounds, with_unit(number, unit)));
}

/// A number as TOML has it, if it is one.
std::optional<double> bare_number(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value.content)) return static_cast<double>(*whole);
  if (const auto* real = std::get_if<double>(&value.content)) return *real;
  return std::nullopt;
}

bool is_auto(const Value& value) {
  const auto* text = std::get_if<std::string>(&value.content);
  return text && *text == "auto";
}

double unchecked_number(const Value& value, std::string_view unit) {
  const auto expected = [unit] {
    return fmt::format("{} is expected, for example \"{}\"", measured_by(unit), example_quantity(unit));
  };
  if (is_auto(value)) throw InputError("this key has no \"auto\"; " + expected());
  if (const auto* text = std::get_if<std::string>(&value.content)) return to_si(*text, unit);
  const auto bare = bare_number(value);
  if (!bare) throw InputError(expected());
  if (!std::isfinite(*bare)) throw InputError("not a finite number");
  // Without its unit a number goes the way of a text without unit, which is refused with an example.
  return is_plain(unit) ? *bare : to_si(written(value), unit);
}

/// A number in SI; `unit` is the parameter's own, or one of the two of a curve.
double number(const Value& value, const Parameter& parameter, std::string_view unit) {
  double result = 0;
  try {
    result = unchecked_number(value, unit);
  } catch (const InputError& error) {
    throw InputError(error.what() + in_parentheses(describe_allowed(parameter)));
  }
  check_range(result, parameter.range, unit);
  return result;
}

/// Whole numbers may be written as 1e6 as well, as long as a double holds them exactly.
std::int64_t whole_number(const Value& value, const Parameter& parameter) {
  const auto* whole = std::get_if<std::int64_t>(&value.content);
  const auto bare = bare_number(value);
  if (!whole && !(bare && std::abs(*bare) <= exact_in_double && *bare == std::trunc(*bare)))
    throw InputError(fmt::format("a whole number is expected, without quotes, for example {}{}",
                                 example(parameter), in_parentheses(describe_allowed(parameter))));
  check_range(*bare, parameter.range, "1");
  return whole ? *whole : static_cast<std::int64_t>(*bare);
}

std::string text_of(const Value& value, const Parameter& parameter) {
  const auto* text = std::get_if<std::string>(&value.content);
  const std::vector<std::string> choices = choices_of(parameter);
  if (!text) throw InputError("a text in quotes is expected" + in_parentheses(quoted_list(choices)));
  if (choices.empty() || std::ranges::find(choices, *text) != choices.end()) return *text;
  auto suggestion = closest(*text, choices);
  if (suggestion) suggestion = in_quotes(*suggestion);
  throw InputError(
      fmt::format("not one of the choices{} (allowed: {})", did_you_mean(suggestion), quoted_list(choices)));
}

const List& list_of(const Value& value, const Parameter& parameter) {
  const auto* list = std::get_if<List>(&value.content);
  if (!list) throw InputError("a list is expected, for example " + example(parameter));
  return *list;
}

/// Applies `read` to each element; a problem says which element has it.
template <typename Result, typename Read>
std::vector<Result> each(const List& list, Read read) {
  std::vector<Result> results;
  results.reserve(list.size());
  for (const Value& element : list) {
    try {
      results.push_back(read(element));
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("element {}, {}: {}", results.size() + 1, shortened(written(element)), error.what()));
    }
  }
  return results;
}

CurvePoint curve_point(const Value& value, const Parameter& parameter) {
  const auto* pair = std::get_if<List>(&value.content);
  if (!pair || pair->size() != 2)
    throw InputError("a point of the curve is a list of two values, as in " + example(parameter));
  const auto [first, second] = curve_units(parameter.unit);
  return {number((*pair)[0], parameter, first), number((*pair)[1], parameter, second)};
}

struct Store {
  const Value& value;
  const Parameter& parameter;

  void operator()(double* target) const { *target = number(value, parameter, parameter.unit); }
  void operator()(std::int64_t* target) const { *target = whole_number(value, parameter); }
  void operator()(bool* target) const {
    const auto* flag = std::get_if<bool>(&value.content);
    if (!flag) throw InputError("true or false is expected, without quotes");
    *target = *flag;
  }
  void operator()(std::string* target) const { *target = text_of(value, parameter); }
  void operator()(const EnumTarget& target) const { target.set(text_of(value, parameter)); }
  void operator()(const ListTarget&) const {
    throw std::logic_error(parameter.key + " is read table by table");
  }
  void operator()(std::vector<std::string>* target) const {
    *target = each<std::string>(list_of(value, parameter),
                                [this](const Value& element) { return text_of(element, parameter); });
  }
  void operator()(std::vector<double>* target) const {
    *target = each<double>(list_of(value, parameter), [this](const Value& element) {
      return number(element, parameter, parameter.unit);
    });
  }
  void operator()(std::vector<CurvePoint>* target) const {
    *target = each<CurvePoint>(list_of(value, parameter),
                               [this](const Value& element) { return curve_point(element, parameter); });
  }
  template <typename T>
  void operator()(std::optional<T>* target) const {
    if (is_auto(value)) {
      target->reset();
      return;
    }
    T given{};
    (*this)(&given);
    *target = given;
  }
};

/// The value that a target holds, as a user would write it.
struct Written {
  const Parameter& parameter;

  Value number(double value, std::string_view unit) const {
    if (!is_plain(unit))
      return {written_in(parameter.default_in.empty() ? unit : parameter.default_in, value, unit)};
    const bool whole = value == std::trunc(value) && std::abs(value) <= exact_in_double;
    return whole ? Value{static_cast<std::int64_t>(value)} : Value{value};
  }

  Value operator()(const double* target) const { return number(*target, parameter.unit); }
  Value operator()(const EnumTarget& target) const { return {target.name()}; }
  Value operator()(const ListTarget& target) const { return std::visit(*this, target.prototype()); }
  Value operator()(const std::vector<CurvePoint>* target) const {
    const auto [first, second] = curve_units(parameter.unit);
    List points;
    for (const auto& [x, y] : *target) points.push_back({List{number(x, first), number(y, second)}});
    return {points};
  }
  Value operator()(const std::vector<double>* target) const {
    List numbers;
    for (const double value : *target) numbers.push_back(number(value, parameter.unit));
    return {numbers};
  }
  Value operator()(const std::vector<std::string>* target) const {
    List texts;
    for (const std::string& text : *target) texts.push_back({text});
    return {texts};
  }
  template <typename T>
  Value operator()(const std::optional<T>* target) const {
    return *target ? (*this)(&**target) : Value{"auto"};
  }
  template <typename T>
  Value operator()(const T* target) const {
    return {*target};
  }
};

}  // namespace

void store(const Value& value, const Parameter& parameter) {
  std::visit(Store{value, parameter}, parameter.target);
}

Value default_value(const Parameter& parameter) {
  return std::visit(Written{parameter}, parameter.target);
}

}  // namespace rhexis::input
