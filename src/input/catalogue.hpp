// SPDX-License-Identifier: BSD-3-Clause
/// Looking up keys and sections in the declarations, and guessing the one that a user meant.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/parameter.hpp"

namespace rhexis::input {

/// "vessel" of "vessel.length"; empty where there is no dot.
std::string section_of(std::string_view key);

/// "length" of "vessel.length"; all of it where there is no dot.
std::string name_of(std::string_view key);

/// "spot.radius" of "spot[2].radius", the second table's of a section that is repeated; others as they are.
std::string without_table(std::string_view key);

/// Whether the key is one of a section that may stand any number of times, [[section]].
bool is_repeated(const Parameter& parameter);

/// What a repeated parameter is in one of its tables, `number` from 1; its value goes to `target`.
Parameter in_table(const Parameter& repeated, std::size_t number, const ElementTarget& target);

/// The sections in the order of their first declaration.
std::vector<std::string> sections_of(const ParameterList& parameters);

/// @throws InputError where `section` is none, with the list of sections.
void check_section(const ParameterList& parameters, std::string_view section);

/// Whether keys of `section` are repeated.
bool is_repeated(const ParameterList& parameters, std::string_view section);

const Parameter* find(const ParameterList& parameters, std::string_view key);

/// The key that `unknown` was probably meant to be: the same name in another section, or a similar one.
std::optional<std::string> similar_key(const ParameterList& parameters, std::string_view unknown);

}  // namespace rhexis::input
