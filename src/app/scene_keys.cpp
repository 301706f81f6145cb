// SPDX-License-Identifier: BSD-3-Clause
#include "app/scene_keys.hpp"

#include <algorithm>
#include <optional>

#include "input/catalogue.hpp"
#include "scenes/scene_input.hpp"
#include "scenes/scenes.hpp"

namespace rhexis::app {
namespace {

using scenes::append;
using scenes::declare_coupled_scene;
using scenes::declare_ensemble_scene;
using scenes::declare_network;
using scenes::declare_network_scene;
using scenes::declare_vessel_scene;
using scenes::declare_wall;
using scenes::Model;

ParameterList declare_scene(Configuration& c) {
  return {
      {.key = "scene.title", .target = &c.title, .meaning = "What the run shows; stored with the results."},
      {.key = "scene.model",
       .target = &c.model,
       .meaning =
           "What is simulated: the rupture of one vessel's wall; the flow in a network of vessels; both: the "
           "rupture of a vessel of a network; or how probably a vessel ruptures, from many walls "
           "whose properties scatter.",
       .source = "Sec. 3.3"}};
}

/// The keys of a model's scenes besides section scene.
ParameterList declare_keys(Configuration& c, Model model) {
  switch (model) {
    case Model::vessel:
      return declare_vessel_scene(c);
    case Model::network:
      return declare_network_scene(c);
    case Model::coupled:
      return declare_coupled_scene(c);
    case Model::ensemble:
      return declare_ensemble_scene(c);
  }
  return {};
}

}  // namespace

ParameterList declare(Configuration& c) {
  ParameterList all = declare_scene(c);
  append(all, declare_wall(c));
  append(all, peridynamics::declare_start(c.vessel));
  append(all, declare_network(c));
  append(all, coupling::declare(c.coupling));
  append(all, ensemble::declare(c.ensemble));
  append(all, insitu::declare(c.insitu));
  return all;
}

ParameterList declare_model(Configuration& c, const input::Document& document) {
  std::optional<Model> model = c.model;
  for (const input::Entry& entry : document.entries) {
    if (entry.key != "scene.model") continue;
    if (const auto* text = std::get_if<std::string>(&entry.value.content)) model = value_of<Model>(*text);
  }
  if (!model) return declare(c);  // the reader will refuse it
  const ParameterList chosen = declare_keys(c, *model);
  const auto has_section = [](const ParameterList& keys, const std::string& section) {
    const auto sections = input::sections_of(keys);
    return std::find(sections.begin(), sections.end(), section) != sections.end();
  };
  const auto has_key = [](const ParameterList& keys, const std::string& key) {
    return input::find(keys, key) != nullptr;
  };
  const auto refuse = [&](const std::string& place, const std::string& what, const std::string& name,
                          const auto& has) {
    if (has(chosen, name)) return;
    std::string others;
    for (const auto& [other, its_name] : name_table(Model{})) {
      if (has(declare_keys(c, other), name))
        others += (others.empty() ? "\"" : ", \"") + std::string(its_name) + '"';
    }
    if (others.empty()) return;  // the reader will refuse it
    throw InputError(place + ": " + what + " belongs to scenes with scene.model = " + others +
                     "; this scene's is \"" + std::string(name_of(*model)) + "\"");
  };
  for (const input::Section& section : document.sections) {
    refuse(document.file + ":" + std::to_string(section.line), "section [" + section.name + "]", section.name,
           has_section);
  }
  for (const input::Entry& entry : document.entries) {
    const std::string key = input::without_table(entry.key);
    const std::string section = input::section_of(key);
    refuse(document.place(entry), "section [" + section + "]", section, has_section);
    if (model == Model::coupled && scenes::network_sets(entry.key))
      throw InputError(document.place(entry) + ": the network says this of a coupled vessel");
    if (model == Model::coupled && scenes::vessel_sets(entry.key))
      throw InputError(document.place(entry) + ": section [material] says this of a coupled network");
    refuse(document.place(entry), "this key", key, has_key);
  }
  ParameterList all = declare_scene(c);
  append(all, chosen);
  return all;
}

}  // namespace rhexis::app
