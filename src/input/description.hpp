// SPDX-License-Identifier: BSD-3-Clause
/// What a key takes, in words, from its declaration.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/parameter.hpp"

namespace rhexis::input {

/// "greater than 0 m and at most 1 m"; empty where every number is allowed. Bounds and unit are SI.
std::string describe(const Range& range, std::string_view unit);

/// The type and the unit, shortly: "length [m]", "whole number", "list of texts", "curve [s, Pa]".
std::string describe_type(const Parameter& parameter);

/// The words that a text may be; empty where it may be any.
std::vector<std::string> choices_of(const Parameter& parameter);

/// The allowed values: a range, choices, "auto"; empty where anything of the type is.
std::string describe_allowed(const Parameter& parameter);

/// What has to hold for a key to have an effect: `load.schedule = "step" or "ramp"`, a key alone where any
/// value that is given will do, and all of them with "or" between.
std::string describe(const std::vector<Condition>& one_of);

/// A value that the key takes, as TOML.
std::string example(const Parameter& parameter);

/// The units of a curve, "s, Pa", as a pair.
std::pair<std::string, std::string> curve_units(std::string_view unit);

/// Whether the target is an optional one, which the text "auto" leaves empty.
bool takes_auto(const Parameter& parameter);

}  // namespace rhexis::input
