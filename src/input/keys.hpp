// SPDX-License-Identifier: BSD-3-Clause
/// The reference of the input, made from the declarations: the text of `rhexis keys [WHICH]`.
#pragma once

#include <string>
#include <string_view>

#include "core/parameter.hpp"

namespace rhexis::input {

/// All keys of the section `which`, or of every one where it is empty, or the one key of this name, in the
/// order of their declaration: name, type and SI unit, default, allowed values, meaning, source; at most 100
/// columns wide where the words permit.
/// @throws InputError where there is neither.
std::string describe_keys(const ParameterList& parameters, std::string_view which = {});

}  // namespace rhexis::input
