// SPDX-License-Identifier: BSD-3-Clause
/// A survey in words.
#pragma once

#include <string>
#include <vector>

#include "network/survey/network_survey.hpp"

namespace rhexis::network {

struct SurveyLine {
  std::string label, text;
};

/// Lines for the terminal: parts, ranges, extent, vessels without flow, walls that are assumed, notes.
std::vector<SurveyLine> survey_lines(const NetworkSurvey& survey);

/// What the user may have forgotten: conditions at ends, and in whole parts.
std::vector<std::string> survey_warnings(const NetworkSurvey& survey);

/// "a, b, c", and how many there are besides.
std::string list_of(const NamedCount& named);

}  // namespace rhexis::network
