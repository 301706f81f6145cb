// SPDX-License-Identifier: BSD-3-Clause
#include "input/keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "input/catalogue.hpp"
#include "input/description.hpp"
#include "input/document.hpp"
#include "input/values.hpp"
#include "input/wording.hpp"

namespace rhexis::input {
namespace {

constexpr std::size_t width = 100;
constexpr std::size_t margin = 2;

constexpr std::string_view introduction =
    "An input file is TOML: a line [section], then lines name = value. A quantity is a text with its unit, "
    "such as "
    "\"1.5 mm\", \"238 kPa\" or \"1785 mmHg\"; units in brackets and ranges below are SI. Any key can be "
    "changed "
    "for one run: rhexis run FILE --set \"section.name=value\".";

struct Columns {
  std::size_t name = 0;
  std::size_t type = 0;
};

Columns columns_of(const ParameterList& parameters) {
  Columns columns;
  for (const Parameter& parameter : parameters) {
    columns.name = std::max(columns.name, name_of(parameter.key).size());
    columns.type = std::max(columns.type, describe_type(parameter).size());
  }
  return columns;
}

std::string default_and_allowed(const Parameter& parameter) {
  const std::string allowed = describe_allowed(parameter);
  return (parameter.required ? "required, e.g. " + example(parameter)
                             : "default " + written(default_value(parameter))) +
         (allowed.empty() ? "" : "; allowed: " + allowed);
}

std::string describe_key(const Parameter& parameter, const Columns& columns) {
  const std::size_t second = margin + columns.name + 2;
  const std::size_t third = second + columns.type + 2;
  const std::string only =
      parameter.only_with.empty() ? "" : fmt::format(" Only with {}.", describe(parameter.only_with));
  const std::string source = parameter.source.empty() ? "" : fmt::format(" ({})", parameter.source);
  return fmt::format("{:{}}{:{}}  {:{}}  {}\n{:{}}{}\n", "", margin, name_of(parameter.key), columns.name,
                     describe_type(parameter), columns.type,
                     wrapped(default_and_allowed(parameter), width, third), "", second,
                     wrapped(parameter.meaning + only + source, width, second));
}

}  // namespace

std::string describe_keys(const ParameterList& parameters, std::string_view which) {
  const bool one_key = find(parameters, which) != nullptr;
  const std::string section = one_key ? section_of(which) : std::string(which);
  if (!section.empty()) check_section(parameters, section);
  const Columns columns = columns_of(parameters);
  std::string text = wrapped(introduction, width, 0) + "\n";
  for (const std::string& name : sections_of(parameters)) {
    if (!section.empty() && name != section) continue;
    text += is_repeated(parameters, name) ? fmt::format("\n[[{}]]  (any number of them)\n", name)
                                          : fmt::format("\n[{}]\n", name);
    for (const Parameter& parameter : parameters)
      if (section_of(parameter.key) == name && (!one_key || parameter.key == which))
        text += describe_key(parameter, columns);
  }
  return text;
}

}  // namespace rhexis::input
