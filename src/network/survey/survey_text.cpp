// SPDX-License-Identifier: BSD-3-Clause
#include "network/survey/survey_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/format.hpp"

namespace rhexis::network {
namespace {

std::string number(std::size_t count) {
  return grouped(static_cast<long long>(count));
}

/// "no loops", "1 loop", "2 loops".
std::string counted(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count == 0 ? "no" : number(count), what, count == 1 ? "" : "s");
}

std::string range_text(const MeasureRange& range) {
  const std::string least = quantity(range.least, "m"), largest = quantity(range.largest, "m");
  if (least == largest) return least + " of all vessels";
  return fmt::format("from {} (vessel {}) to {} (vessel {})", least, range.least_vessel, largest,
                     range.largest_vessel);
}

std::string extent_text(const std::array<std::pair<double, double>, 3>& extent) {
  std::string text;
  for (const auto& [low, high] : extent)
    text += (text.empty() ? "" : " x ") + (high > low ? quantity(high - low, "m") : "0");
  return text;
}

std::string parts_text(const NetworkSurvey& s) {
  std::string text = fmt::format("{}, {}; {}, {}", number(s.parts), counted(s.loops, "loop"),
                                 counted(s.ends, "end"), counted(s.conditions, "condition"));
  if (s.open_ends.count > 0)
    text +=
        fmt::format("; {} without a condition: {}", counted(s.open_ends.count, "end"), list_of(s.open_ends));
  if (s.isolated.count > 0)
    text +=
        fmt::format("; {} without vessels: {}", counted(s.isolated.count, "junction"), list_of(s.isolated));
  return text;
}

std::string no_flow_text(const NetworkSurvey& s) {
  std::string text = fmt::format("in {} of {}", number(s.without_flow()), counted(s.vessels, "vessel"));
  if (s.dead_ends.count > 0)
    text += fmt::format("; {} in dead ends or loops that hang at one junction: {}", number(s.dead_ends.count),
                        list_of(s.dead_ends));
  if (s.vessels_without_way > 0)
    text += fmt::format("; {} in parts without two conditions", number(s.vessels_without_way));
  return text;
}

}  // namespace

std::string list_of(const NamedCount& named) {
  const std::size_t more = named.count - named.names.size();
  return fmt::format("{}{}", fmt::join(named.names, ", "),
                     more > 0 ? fmt::format(" and {} more", number(more)) : "");
}

std::vector<SurveyLine> survey_lines(const NetworkSurvey& s) {
  std::vector<SurveyLine> lines{
      {"parts", parts_text(s)}, {"radius", range_text(s.radius)}, {"length", range_text(s.length)}};
  if (s.extent) lines.push_back({"extent", extent_text(*s.extent)});
  if (s.without_flow() > 0) lines.push_back({"no flow", no_flow_text(s)});
  if (s.assumed_walls.count > 0) {
    lines.push_back(
        {"walls", s.assumed_walls.count == s.vessels
                      ? "no thickness is given: the rules of [wall] assume that of every vessel"
                      : fmt::format("no thickness is given in {}, where the rules of [wall] assume one: {}",
                                    counted(s.assumed_walls.count, "vessel"), list_of(s.assumed_walls))});
  }
  for (const std::string& note : s.notes) lines.push_back({"note", note});
  return lines;
}

std::vector<std::string> survey_warnings(const NetworkSurvey& s) {
  std::vector<std::string> warnings = s.warnings;
  if (s.open_ends.count > 0) {
    const bool one = s.open_ends.count == 1;
    warnings.push_back(fmt::format(
        "{} no condition, so that nothing flows there: {}; an outlet needs a pressure or a flow",
        one ? "an end of the network has" : number(s.open_ends.count) + " ends of the network have",
        list_of(s.open_ends)));
  }
  // Where nothing flows at all, the solution says so.
  if (s.parts_with_one_opening.count > 0 && s.parts_with_one_opening.count < s.parts) {
    warnings.push_back(
        fmt::format("nothing flows in {} of the network, with one condition only; first junction: {}",
                    counted(s.parts_with_one_opening.count, "part"), list_of(s.parts_with_one_opening)));
  }
  if (s.parts_without_conditions.count > 0) {
    warnings.push_back(fmt::format("{} of the network without any condition; first junction: {}",
                                   counted(s.parts_without_conditions.count, "part"),
                                   list_of(s.parts_without_conditions)));
  }
  return warnings;
}

}  // namespace rhexis::network
