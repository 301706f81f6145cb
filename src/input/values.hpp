// SPDX-License-Identifier: BSD-3-Clause
/// One value of the input, checked against its declaration and put into its typed home.
#pragma once

#include "core/parameter.hpp"
#include "input/document.hpp"

namespace rhexis::input {

/// Converts `value` to SI, checks type, unit, range and choices, and stores it in parameter.target.
/// @throws InputError whose message is the problem alone, without place, key and value.
void store(const Value& value, const Parameter& parameter);

/// The default, which the target of `parameter` holds before anything is stored there, as a user would write
/// it: "1.5 mm", 0.25, "auto" of an optional one that is empty.
Value default_value(const Parameter& parameter);

}  // namespace rhexis::input
