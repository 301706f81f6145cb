// SPDX-License-Identifier: BSD-3-Clause
#include "input/description.hpp"

#include <fmt/format.h>

#include <cmath>

#include "input/units.hpp"
#include "input/wording.hpp"

namespace rhexis::input {
namespace {

std::string in_brackets(std::string_view unit) {
  return is_plain(unit) ? "" : fmt::format(" [{}]", unit);
}

/// A number in the range: the usual example where it fits, else one made from the bounds.
std::string example_number(const Parameter& parameter) {
  const Range& range = parameter.range;
  const std::string usual = example_quantity(parameter.unit);
  const bool fits = range.contains(to_si(usual, parameter.unit));
  if (fits) return is_plain(parameter.unit) ? usual : in_quotes(usual);
  const bool bounded_below = std::isfinite(range.lower);
  const bool bounded_above = std::isfinite(range.upper);
  const double inside = bounded_below && bounded_above ? range.lower + (range.upper - range.lower) / 2
                        : bounded_below                ? range.lower + 1
                                                       : range.upper - 1;
  const std::string text = with_unit(inside, parameter.unit);
  return is_plain(parameter.unit) ? text : in_quotes(text);
}

std::string example_whole(const Range& range) {
  if (range.contains(10)) return "10";
  const double first = std::isfinite(range.lower) ? std::floor(range.lower) + 1 : std::ceil(range.upper) - 1;
  return fmt::format("{:.0f}", first);
}

std::string example_text(const Parameter& parameter) {
  const std::vector<std::string> choices = choices_of(parameter);
  return in_quotes(choices.empty() ? "text" : choices.front());
}

struct TypeName {
  std::string_view unit;

  std::string operator()(const double*) const {
    return is_plain(unit) ? "number"
                          : measured_by(unit).substr(measured_by(unit).find(' ') + 1) + in_brackets(unit);
  }
  std::string operator()(const std::int64_t*) const { return "whole number"; }
  std::string operator()(const bool*) const { return "true or false"; }
  std::string operator()(const std::string*) const { return "text"; }
  std::string operator()(const EnumTarget&) const { return "text"; }
  std::string operator()(const std::vector<std::string>*) const { return "list of texts"; }
  std::string operator()(const std::vector<double>*) const { return "list of numbers" + in_brackets(unit); }
  std::string operator()(const std::vector<CurvePoint>*) const { return "curve" + in_brackets(unit); }
  std::string operator()(const ListTarget& target) const { return std::visit(*this, target.prototype()); }
  template <typename T>
  std::string operator()(const std::optional<T>*) const {
    return (*this)(static_cast<const T*>(nullptr));
  }
};

struct Example {
  const Parameter& parameter;

  std::string operator()(const double*) const { return example_number(parameter); }
  std::string operator()(const std::int64_t*) const { return example_whole(parameter.range); }
  std::string operator()(const bool*) const { return "true"; }
  std::string operator()(const std::string*) const { return example_text(parameter); }
  std::string operator()(const EnumTarget&) const { return example_text(parameter); }
  std::string operator()(const ListTarget& target) const { return std::visit(*this, target.prototype()); }
  std::string operator()(const std::vector<std::string>*) const {
    return fmt::format("[{}]", example_text(parameter));
  }
  std::string operator()(const std::vector<double>*) const {
    return fmt::format("[{}]", example_number(parameter));
  }
  std::string operator()(const std::vector<CurvePoint>*) const {
    const auto [x, y] = curve_units(parameter.unit);
    return fmt::format("[[{}, {}]]", in_quotes(example_quantity(x)), in_quotes(example_quantity(y)));
  }
  template <typename T>
  std::string operator()(const std::optional<T>*) const {
    return (*this)(static_cast<const T*>(nullptr));
  }
};

}  // namespace

std::string describe(const Range& range, std::string_view unit) {
  std::string lower, upper;
  if (std::isfinite(range.lower))
    lower = (range.lower_open ? "greater than " : "at least ") + with_unit(range.lower, unit);
  if (std::isfinite(range.upper))
    upper = (range.upper_open ? "less than " : "at most ") + with_unit(range.upper, unit);
  return lower + (!lower.empty() && !upper.empty() ? " and " : "") + upper;
}

std::string describe(const std::vector<Condition>& one_of) {
  std::string text;
  for (const auto& [key, values] : one_of) {
    text += text.empty() ? "" : values.empty() ? " or " : ", or ";
    text += values.empty() ? key : fmt::format("{} = {}", key, fmt::join(values, " or "));
  }
  return text;
}

std::string describe_type(const Parameter& parameter) {
  return std::visit(TypeName{parameter.unit}, parameter.target);
}

std::vector<std::string> choices_of(const Parameter& parameter) {
  const auto* target = std::get_if<EnumTarget>(&parameter.target);
  return target && parameter.choices.empty() ? target->names() : parameter.choices;
}

std::string describe_allowed(const Parameter& parameter) {
  std::string allowed = quoted_list(choices_of(parameter));
  const bool curve = std::holds_alternative<std::vector<CurvePoint>*>(parameter.target);
  if (allowed.empty()) allowed = describe(parameter.range, curve ? "1" : parameter.unit);
  if (!takes_auto(parameter)) return allowed;
  return allowed.empty() ? "a value or \"auto\"" : allowed + ", or \"auto\"";
}

std::string example(const Parameter& parameter) {
  return std::visit(Example{parameter}, parameter.target);
}

std::pair<std::string, std::string> curve_units(std::string_view unit) {
  const auto comma = unit.find(',');
  if (comma == std::string_view::npos)
    throw std::logic_error(fmt::format("a curve needs two units, as in \"s, Pa\", not \"{}\"", unit));
  const auto second = unit.find_first_not_of(' ', comma + 1);
  return {std::string(unit.substr(0, comma)), std::string(unit.substr(second))};
}

bool takes_auto(const Parameter& parameter) {
  if (const auto* list = std::get_if<ListTarget>(&parameter.target))
    return std::holds_alternative<std::optional<double>*>(list->prototype());
  return std::holds_alternative<std::optional<double>*>(parameter.target) ||
         std::holds_alternative<std::optional<std::int64_t>*>(parameter.target);
}

}  // namespace rhexis::input
