// SPDX-License-Identifier: BSD-3-Clause
/// Names of columns, members and attributes as people and programs write them, with their units: "radius
/// [um]", "Wall Thickness (mm)", "wall_thickness".
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scanning.hpp"

namespace rhexis {

/// Turns a quantity as written ("1 um") into SI ("m"); throws InputError.
using ToSi = std::function<double(std::string_view text, std::string_view unit)>;

/// What a column holds: its name here, the SI unit of its numbers ("": text, "1": no unit), and the names
/// that other programs give it.
struct Column {
  std::string name, unit;
  std::vector<std::string> aliases = {};
};
using Columns = std::vector<Column>;

/// A name and the unit in brackets after it; empty where there are none.
struct Heading {
  std::string name, unit;
};

/// "radius [um]" or "radius (um)". A bracket without its end is part of the name.
inline Heading parsed_heading(std::string_view text) {
  const auto open = text.find_first_of("[(");
  const auto close = open == std::string_view::npos ? open : text.find(text[open] == '[' ? ']' : ')', open);
  if (close == std::string_view::npos) return {std::string(without_blanks(text)), ""};
  return {std::string(without_blanks(text.substr(0, open))),
          std::string(without_blanks(text.substr(open + 1, close - open - 1)))};
}

/// A name in lower case and without blanks, underscores and hyphens: what two spellings have in common.
inline std::string spelling(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (c == ' ' || c == '_' || c == '-' || c == '\t') continue;
    plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return plain;
}

/// The column that a heading names in any spelling, itself or by an alias; null where there is none.
inline const Column* find_column(const Columns& columns, std::string_view name) {
  const std::string wanted = spelling(name);
  const auto found = std::ranges::find_if(columns, [&](const Column& column) {
    return spelling(column.name) == wanted ||
           std::ranges::any_of(column.aliases,
                               [&](const std::string& alias) { return spelling(alias) == wanted; });
  });
  return found == columns.end() ? nullptr : &*found;
}

/// What turns the numbers of a column into SI.
struct UnitOfColumn {
  std::optional<double> factor;     ///< none: the unit is not told
  bool is_the_length_unit = false;  ///< it is that of lengths whose heading tells none
};

/// The unit of a column's numbers: as its heading tells, else `length_unit` (empty: not known) if they are
/// lengths. Texts have none, and fractions may be in "%". Throws what `to_si` throws of another unit.
inline UnitOfColumn unit_of(const Column& column, const Heading& heading, const std::string& length_unit,
                            const ToSi& to_si) {
  if (column.unit.empty()) return {1.0};
  if (column.unit == "1") return {heading.unit == "%" ? 0.01 : 1.0};
  const bool is_the_length_unit = heading.unit.empty() && column.unit == "m" && !length_unit.empty();
  const std::string& unit = is_the_length_unit ? length_unit : heading.unit;
  if (unit.empty()) return {};
  return {to_si("1 " + unit, column.unit), is_the_length_unit};
}

/// "id, x, y": the names of all columns.
inline std::string names_of(const Columns& columns) {
  std::string names;
  for (const Column& column : columns) names += (names.empty() ? "" : ", ") + column.name;
  return names;
}

}  // namespace rhexis
