// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/checkpoint_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/format.hpp"
#include "input/catalogue.hpp"
#include "input/difference.hpp"

namespace rhexis::scenes {
namespace {

using Json = nlohmann::ordered_json;

bool is_in(const auto& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}

/// The sections that make a body what it is: a checkpoint can only be restored to the same.
bool of_the_body(const std::string& key) {
  constexpr std::array sections = {"vessel", "material", "scatter", "spot", "discretisation", "boundary"};
  return is_in(sections, input::section_of(input::without_table(key)));
}

/// The keys that say what happens to a body; the others say how long, and what is shown.
bool of_its_load(const std::string& key) {
  constexpr std::array others = {"scene", "time", "output", "insitu", "screening"};
  constexpr std::array shown = {"network.query", "network.statistics", "network.shown_vessels",
                                "network.shown_subtree", "network.vtp"};
  return !of_the_body(key) && !is_in(others, input::section_of(key)) && !is_in(shown, key);
}

/// What a network may say of a body, as a record of input has it.
Json measures(const peridynamics::Parameters& v) {
  const auto entry = [](double value, const std::string& written) {
    return Json{{"written", written}, {"value", value}};
  };
  return {{"vessel",
           {{"inner_radius", entry(v.inner_radius, quantity(v.inner_radius, "m"))},
            {"outer_radius", entry(v.outer_radius, quantity(v.outer_radius, "m"))},
            {"length", entry(v.length, quantity(v.length, "m"))}}},
          {"material", {{"critical_stretch", entry(*v.critical_stretch, text(*v.critical_stretch))}}}};
}

Json read_json(output::CheckpointReader& file, const std::string& name) {
  std::string text;
  file.read(name, text);
  Json json = Json::parse(text, nullptr, false);
  if (!input::is_record(json)) file.refuse(fmt::format("its '{}' is not the record of an input", name));
  return json;
}

}  // namespace

void write_input(output::CheckpointWriter& file, const SceneInput& s, const peridynamics::Parameters* wall) {
  file.write("input", record_of(s).dump());
  if (wall != nullptr) file.write("measures", measures(*wall).dump());
}

void compare_input(output::CheckpointReader& file, SceneInput& s, const peridynamics::Parameters* wall,
                   const std::string& since) {
  const Json input = read_json(file, "input"), now = record_of(s);
  auto of_body = input::differences(input, now, of_the_body);
  if (of_body.empty() && wall != nullptr)
    of_body = input::differences(read_json(file, "measures"), measures(*wall), of_the_body);
  if (!of_body.empty()) file.refuse("the checkpoint is of another body: " + of_body.front().text);
  for (const input::Difference& d : input::differences(input, now, of_its_load))
    s.warnings.push_back(fmt::format("{}, from {} on", d.text, since));
}

}  // namespace rhexis::scenes
