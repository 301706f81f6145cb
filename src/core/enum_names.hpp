// SPDX-License-Identifier: BSD-3-Clause
/// The words by which input files, messages and records know the values of an enum: one table beside each
/// enum.
///
///   enum class Venting { none, orifice };
///   constexpr auto name_table(Venting) {
///     using enum Venting;
///     return std::to_array<Named<Venting>>({{none, "none"}, {orifice, "orifice"}});
///   }
#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <type_traits>

namespace rhexis {

/// A value of an enum and its word.
template <class Enum>
struct Named {
  Enum value;
  std::string_view name;
};

/// An enum with a table of names, which argument-dependent lookup finds.
template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires(Enum value) {
  name_table(value).begin()->name;
};

template <NamedEnum Enum>
constexpr std::string_view name_of(Enum value) {
  for (const auto& [named, name] : name_table(value))
    if (named == value) return name;
  throw std::logic_error("a value of an enum is missing in its table of names");
}

/// The value of this name; none where the enum has none.
template <NamedEnum Enum>
constexpr std::optional<Enum> value_of(std::string_view name) {
  for (const auto& [value, its_name] : name_table(Enum{}))
    if (its_name == name) return value;
  return std::nullopt;
}

}  // namespace rhexis
