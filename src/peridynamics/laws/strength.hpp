// SPDX-License-Identifier: BSD-3-Clause
/// What it takes to tear the wall: critical stretch s0 and energy release rate G0, each from the other.
#pragma once

#include <string>

#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

/// Fills critical_stretch: as given, or from energy_release_rate (needs the horizon), or 0.25 (Table 2).
/// Throws InputError where the law is at fault (law_parameters.hpp) or knows no G0, where both are given, or
/// where G0 asks for a stretch beyond what s0 may be.
void resolve_critical_stretch(Parameters& p);

/// Both of resolved parameters, in words.
std::string describe_strength(const Parameters& p);

}  // namespace rhexis::peridynamics
