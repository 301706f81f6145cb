// SPDX-License-Identifier: BSD-3-Clause
#include "app/scene_keys.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "input/catalogue.hpp"

namespace rhexis::app {
namespace {

/// Calls `visit` with an empty scene of each kind.
template <class Visit>
void for_each_kind(const Visit& visit) {
  [&]<std::size_t... Kind>(std::index_sequence<Kind...>) {
    (visit(std::variant_alternative_t<Kind, Configuration>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Configuration>>{});
}

ParameterList declare_scene(std::string& title, std::string& model) {
  std::vector<std::string> models;
  for_each_kind([&](const auto& scene) { models.emplace_back(scene.model); });
  return {
      {.key = "scene.title", .target = &title, .meaning = "What the run shows; stored with the results."},
      {.key = "scene.model",
       .target = &model,
       .meaning =
           "What is simulated: the rupture of one vessel's wall; the flow in a network of vessels; both: the "
           "rupture of a vessel of a network; or how probably a vessel ruptures, from many walls "
           "whose properties scatter.",
       .source = "Sec. 3.3",
       .choices = models}};
}

bool has_section(const ParameterList& keys, const std::string& section) {
  const auto sections = input::sections_of(keys);
  return std::ranges::find(sections, section) != sections.end();
}

bool has_key(const ParameterList& keys, const std::string& key) {
  return input::find(keys, key) != nullptr;
}

/// The kinds of scene whose keys `have` what is looked for, as a list of their names in quotes.
template <class Have>
std::string kinds_that(const Have& have) {
  std::string kinds;
  for_each_kind([&](auto scene) {
    if (have(scenes::declare(scene)))
      kinds += (kinds.empty() ? "\"" : ", \"") + std::string(scene.model) + '"';
  });
  return kinds;
}

}  // namespace

AllKeys::AllKeys() : model_(scenes::VesselScene::model), list_(declare_scene(vessel_.title, model_)) {
  scenes::append(list_, scenes::declare_wall(vessel_.vessel, vessel_.output));
  scenes::append(list_, peridynamics::declare_start(vessel_.vessel));
  scenes::append(list_, scenes::declare_network(network_));
  scenes::append(list_, coupling::declare(coupling_));
  scenes::append(list_, ensemble::declare(ensemble_));
  scenes::append(list_, insitu::declare(vessel_.pictures.insitu));
}

std::optional<Configuration> scene_named(const input::Document& document) {
  std::string model = scenes::VesselScene::model;
  for (const input::Entry& entry : document.entries) {
    if (entry.key != "scene.model") continue;
    if (const auto* text = std::get_if<std::string>(&entry.value.content)) model = *text;
  }
  std::optional<Configuration> named;
  for_each_kind([&](auto scene) {
    if (scene.model == model) named = std::move(scene);
  });
  return named;
}

ParameterList declare(Configuration& scene, std::string& model) {
  ParameterList all = declare_scene(input_of(scene).title, model);
  scenes::append(all, std::visit([](auto& s) { return scenes::declare(s); }, scene));
  return all;
}

void refuse_keys_of_other_kinds(const input::Document& document, const ParameterList& keys,
                                const std::string& model) {
  const auto refuse = [&](const std::string& place, const std::string& what, const std::string& name,
                          bool (*has)(const ParameterList&, const std::string&)) {
    if (has(keys, name)) return;
    const std::string others = kinds_that([&](const ParameterList& of_kind) { return has(of_kind, name); });
    if (others.empty()) return;  // the reader will refuse it
    throw InputError(place + ": " + what + " belongs to scenes with scene.model = " + others +
                     "; this scene's is \"" + model + "\"");
  };
  for (const input::Section& section : document.sections) {
    refuse(document.file + ":" + std::to_string(section.line), "section [" + section.name + "]", section.name,
           has_section);
  }
  for (const input::Entry& entry : document.entries) {
    const std::string key = input::without_table(entry.key);
    const std::string section = input::section_of(key);
    refuse(document.place(entry), "section [" + section + "]", section, has_section);
    if (model == scenes::CoupledScene::model) scenes::refuse_coupled_key(entry.key, document.place(entry));
    refuse(document.place(entry), "this key", key, has_key);
  }
}

}  // namespace rhexis::app
