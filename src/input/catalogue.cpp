// SPDX-License-Identifier: BSD-3-Clause
#include "input/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "input/wording.hpp"

namespace rhexis::input {

std::string section_of(std::string_view key) {
  const auto dot = key.find('.');
  return dot == std::string_view::npos ? "" : std::string(key.substr(0, dot));
}

std::string name_of(std::string_view key) {
  const auto dot = key.find('.');
  return std::string(dot == std::string_view::npos ? key : key.substr(dot + 1));
}

std::string without_table(std::string_view key) {
  const auto open = key.find('['), close = key.find(']');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open)
    return std::string(key);
  return std::string(key.substr(0, open)) + std::string(key.substr(close + 1));
}

bool is_repeated(const Parameter& parameter) {
  return std::holds_alternative<ListTarget>(parameter.target);
}

Parameter in_table(const Parameter& repeated, std::size_t number, const ElementTarget& target) {
  Parameter parameter = repeated;
  parameter.key = fmt::format("{}[{}].{}", section_of(repeated.key), number, name_of(repeated.key));
  parameter.target = std::visit([](auto* member) { return ParameterTarget(member); }, target);
  return parameter;
}

std::vector<std::string> sections_of(const ParameterList& parameters) {
  std::vector<std::string> sections;
  for (const Parameter& parameter : parameters) {
    auto section = section_of(parameter.key);
    if (std::ranges::find(sections, section) == sections.end()) sections.push_back(std::move(section));
  }
  return sections;
}

void check_section(const ParameterList& parameters, std::string_view section) {
  const auto sections = sections_of(parameters);
  if (std::ranges::find(sections, section) != sections.end()) return;
  throw InputError(fmt::format("there is no section '{}'{} (sections: {})", section,
                               did_you_mean(closest(section, sections)), fmt::join(sections, ", ")));
}

bool is_repeated(const ParameterList& parameters, std::string_view section) {
  return std::ranges::any_of(parameters, [&](const Parameter& parameter) {
    return is_repeated(parameter) && section_of(parameter.key) == section;
  });
}

const Parameter* find(const ParameterList& parameters, std::string_view key) {
  const auto found = std::ranges::find(parameters, key, &Parameter::key);
  return found == parameters.end() ? nullptr : &*found;
}

std::optional<std::string> similar_key(const ParameterList& parameters, std::string_view unknown) {
  const std::string name = name_of(unknown);
  std::vector<std::string> all, names_beside;
  for (const Parameter& parameter : parameters) {
    if (name_of(parameter.key) == name) return parameter.key;
    if (section_of(parameter.key) == section_of(unknown)) names_beside.push_back(name_of(parameter.key));
    all.push_back(parameter.key);
  }
  if (const auto beside = closest(name, names_beside)) return section_of(unknown) + "." + *beside;
  return closest(unknown, all);
}

}  // namespace rhexis::input
