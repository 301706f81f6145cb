/// The reference of the input, made from the declarations: the text of `rhexis keys [SECTION]`.
#pragma once

#include <string>
#include <string_view>

#include "core/parameter.hpp"

namespace rhexis::input {

/// All keys of `section`, or of every section where it is empty, in the order of their declaration: name,
/// type and SI unit, default, allowed values, meaning, source; at most 100 columns wide where the words
/// permit.
/// @throws InputError where there is no such section.
std::string describe_keys(const ParameterList& parameters, std::string_view section = {});

}  // namespace rhexis::input
