// SPDX-License-Identifier: BSD-3-Clause
#include "input/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "input/catalogue.hpp"
#include "input/description.hpp"
#include "input/values.hpp"
#include "input/wording.hpp"

namespace rhexis::input {
namespace {

void check_sections(const Document& document, const ParameterList& parameters) {
  for (const Section& section : document.sections) {
    try {
      check_section(parameters, section.name);
      const bool repeated = is_repeated(parameters, section.name);
      if (section.table > 0 && !repeated)
        throw InputError(fmt::format("[[{0}]] is a list of sections; write [{0}], once", section.name));
      if (section.table == 0 && repeated)
        throw InputError(fmt::format("there may be several of these; write [[{}]]", section.name));
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}:{}: [{}]: {}", document.file, section.line, section.name, error.what()));
    }
  }
}

/// `parameters`: those that the document may set; `declared`: all, for advice.
[[noreturn]] void refuse_unknown(const Document& document, const Entry& entry,
                                 const ParameterList& parameters, const ParameterList& declared) {
  const std::string section = section_of(without_table(entry.key));
  const auto sections = sections_of(declared);
  const bool known_section = std::ranges::find(sections, section) != sections.end();
  const std::string problem =
      section.empty() ? "a key stands in a section, as in section.name" : "there is no such key";
  const std::string help = known_section
                               ? fmt::format("'rhexis keys {}' lists the keys of this section", section)
                               : fmt::format("sections: {}", fmt::join(sections, ", "));
  throw InputError(fmt::format("{}: {}{} ({})", document.place(entry), problem,
                               did_you_mean(similar_key(parameters, entry.key)), help),
                   entry.key);
}

[[noreturn]] void refuse_missing(const Document& document, const Parameter& parameter) {
  const std::string allowed = describe_allowed(parameter);
  const std::string section = section_of(without_table(parameter.key));
  const bool in_a_list = without_table(parameter.key) != parameter.key;
  throw InputError(
      fmt::format("{}: {} is missing; under {} write for example {} = {} ({}{}). Meaning: {}", document.file,
                  parameter.key, in_a_list ? "its [[" + section + "]]" : "[" + section + "]",
                  name_of(parameter.key), example(parameter), describe_type(parameter),
                  allowed.empty() ? "" : "; allowed: " + allowed, parameter.meaning),
      parameter.key);
}

struct ToSiValue {
  SiValue operator()(const EnumTarget& target) const { return target.name(); }
  SiValue operator()(const ListTarget& target) const { return std::visit(*this, target.prototype()); }
  template <typename T>
  SiValue operator()(const std::optional<T>* target) const {
    return *target ? (*this)(&**target) : std::monostate{};
  }
  template <typename T>
  SiValue operator()(const T* target) const {
    return SiValue(std::in_place_type<T>, *target);
  }
};

SiValue stored(const Parameter& parameter) {
  return std::visit(ToSiValue{}, parameter.target);
}

/// Stores the value and records it; a problem is thrown with `place` in front.
ResolvedValue resolve(const Parameter& parameter, const Value& value, std::string origin, std::string place) {
  try {
    store(value, parameter);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place, error.what()), parameter.key);
  }
  return {.key = parameter.key,
          .given = value,
          .value = stored(parameter),
          .unit = parameter.unit,
          .origin = std::move(origin),
          .place = std::move(place)};
}

ResolvedValue resolve_default(const Document& document, const Parameter& parameter) {
  if (parameter.required) refuse_missing(document, parameter);
  const Value value = default_value(parameter);
  return {
      .key = parameter.key,
      .given = value,
      .value = stored(parameter),
      .unit = parameter.unit,
      .origin = "default",
      .place = fmt::format("{}: {} (default {})", document.file, parameter.key, shortened(written(value)))};
}

/// Parameters with one for each table of the document in place of each that is repeated.
ParameterList with_tables(const Document& document, const ParameterList& declared) {
  ParameterList parameters;
  for (const Parameter& parameter : declared) {
    const auto* list = std::get_if<ListTarget>(&parameter.target);
    if (list == nullptr) {
      parameters.push_back(parameter);
      continue;
    }
    const std::string section = section_of(parameter.key);
    const auto tables =
        static_cast<std::size_t>(std::ranges::count(document.sections, section, &Section::name));
    list->resize(tables);
    for (std::size_t i = 0; i < tables; ++i) parameters.push_back(in_table(parameter, i + 1, list->at(i)));
  }
  return parameters;
}

bool holds(const Condition& condition, const ResolvedValue& value) {
  return condition.values.empty()
             ? value.origin != "default"
             : std::ranges::find(condition.values, written(value.given)) != condition.values.end();
}

/// The warning of a key that was given although others, as resolved, leave it without effect; else empty.
/// Conditions on keys that this scene does not have do not count.
std::string warning_of(const Parameter& parameter, const ResolvedValue& value, const Resolved& resolved) {
  const std::vector<Condition>& one_of = parameter.only_with;
  if (one_of.empty() || value.origin == "default") return {};
  std::string as_they_are;
  for (const Condition& condition : one_of) {
    const auto other = std::ranges::find(resolved.values, condition.key, &ResolvedValue::key);
    if (other == resolved.values.end() || holds(condition, *other)) return {};
    if (condition.values.empty()) continue;
    as_they_are += as_they_are.empty() ? "" : " and ";
    as_they_are += fmt::format("{} = {}", condition.key, shortened(written(other->given)));
  }
  if (as_they_are.empty()) return fmt::format("{}: has no effect without {}", value.place, describe(one_of));
  const std::string needed =
      one_of.size() > 1 ? describe(one_of) : fmt::format("{}", fmt::join(one_of.front().values, " or "));
  return fmt::format("{}: has no effect where {}, only with {}", value.place, as_they_are, needed);
}

struct ToJson {
  nlohmann::ordered_json operator()(std::monostate) const { return nullptr; }
  nlohmann::ordered_json operator()(const List& list) const {
    auto json = nlohmann::ordered_json::array();
    for (const Value& element : list) json.push_back(std::visit(*this, element.content));
    return json;
  }
  nlohmann::ordered_json operator()(const auto& held) const { return held; }
};

}  // namespace

Resolved read(const Document& document, const ParameterList& declared) {
  check_sections(document, declared);
  const ParameterList parameters = with_tables(document, declared);
  std::vector<ResolvedValue> given;
  for (const Entry& entry : document.entries) {
    const Parameter* parameter = find(parameters, entry.key);
    if (!parameter) refuse_unknown(document, entry, parameters, declared);
    given.push_back(
        resolve(*parameter, entry.value, entry.from_file() ? "file" : "--set", document.place(entry)));
  }
  Resolved resolved{.file = document.file, .values = {}, .warnings = {}};
  for (const Parameter& parameter : parameters) {
    const auto found = std::ranges::find(given, parameter.key, &ResolvedValue::key);
    resolved.values.push_back(found != given.end() ? std::move(*found)
                                                   : resolve_default(document, parameter));
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string warning = warning_of(parameters[i], resolved.values[i], resolved);
    if (!warning.empty()) resolved.warnings.push_back(warning);
  }
  return resolved;
}

InputError located(const InputError& error, const Resolved& resolved) {
  const auto value = std::ranges::find(resolved.values, error.key, &ResolvedValue::key);
  std::string place = resolved.file;
  if (value != resolved.values.end())
    place = value->place;
  else if (!error.key.empty())
    place += ": " + error.key;
  return InputError(fmt::format("{}: {}", place, error.what()), error.key);
}

nlohmann::ordered_json to_json(const Resolved& resolved) {
  auto json = nlohmann::ordered_json::object();
  for (const ResolvedValue& value : resolved.values)
    json[section_of(value.key)][name_of(value.key)] = {{"written", std::visit(ToJson{}, value.given.content)},
                                                       {"value", std::visit(ToJson{}, value.value)},
                                                       {"unit", value.unit},
                                                       {"origin", value.origin}};
  return json;
}

}  // namespace rhexis::input
