// SPDX-License-Identifier: BSD-3-Clause
#include "app/scene_keys.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "input/catalogue.hpp"
#include "peridynamics/monitors/particle_source.hpp"

namespace rhexis::app {
namespace {

void append(ParameterList& all, const ParameterList& part) {
  all.insert(all.end(), part.begin(), part.end());
}

ParameterList declare_scene(Configuration& c) {
  return {
      {.key = "scene.title", .target = &c.title, .meaning = "What the run shows; stored with the results."},
      {.key = "scene.model",
       .target = &c.model,
       .meaning =
           "What is simulated: the rupture of one vessel's wall; the flow in a network of vessels; both: the "
           "rupture of a vessel of a network; or how probably a vessel ruptures, from many walls "
           "whose properties scatter.",
       .source = "Sec. 3.3",
       .choices = {"vessel", "network", "coupled", "ensemble"}}};
}

ParameterList declare_vessel(Configuration& c) {
  ParameterList all = peridynamics::declare(c.vessel);
  std::vector<std::string> fields;
  for (const FieldInfo& field : peridynamics::ParticleSource::all_fields()) fields.emplace_back(field.name);
  append(all, output::declare(c.output, fields));
  return all;
}

ParameterList declare_network(Configuration& c) {
  ParameterList all = network::declare(c.network);
  append(all, hemodynamics::declare(c.hemodynamics));
  append(all, screening::declare(c.screening));
  return all;
}

/// Keys of a network that its vessel takes over where they are coupled.
bool vessel_knows(const std::string& key) {
  return key == "wall.young_modulus" || key == "wall.poisson_ratio" || key == "screening.critical_stretch";
}

ParameterList declare_coupled(Configuration& c) {
  ParameterList all = coupling::declare(c.coupling);
  for (const Parameter& parameter : declare_vessel(c)) {
    if (!network_knows(parameter.key)) all.push_back(parameter);
  }
  for (const Parameter& parameter : declare_network(c)) {
    if (!vessel_knows(parameter.key)) all.push_back(parameter);
  }
  return all;
}

/// Keys of a vessel that an ensemble takes over, or that do nothing there: walls take a stable time step
/// each, and are simulated to the onset of rupture, before any venting and without output.
bool ensemble_settles(const std::string& key) {
  return input::section_of(key) == "output" || key == "load.pressure" || key == "load.table" ||
         key == "load.table_file" || key == "load.repeat" || key == "load.venting" ||
         key == "load.supply_area" || key == "load.discharge_coefficient" || key == "load.blood_density" ||
         key == "time.step" || key == "time.allow_unstable";
}

ParameterList declare_ensemble(Configuration& c) {
  ParameterList all = ensemble::declare(c.ensemble);
  for (Parameter& parameter : declare_vessel(c)) {
    if (parameter.key == "load.schedule") std::erase(parameter.choices, "table");
    if (!ensemble_settles(parameter.key)) all.push_back(parameter);
  }
  return all;
}

}  // namespace

ParameterList declare(Configuration& c) {
  ParameterList all = declare_scene(c);
  append(all, declare_vessel(c));
  append(all, peridynamics::declare_start(c.vessel));
  append(all, declare_network(c));
  append(all, coupling::declare(c.coupling));
  append(all, ensemble::declare(c.ensemble));
  append(all, insitu::declare(c.insitu));
  return all;
}

ParameterList declare_model(Configuration& c, const input::Document& document) {
  std::pair<std::string, ParameterList> models[] = {{"vessel", declare_vessel(c)},
                                                    {"network", declare_network(c)},
                                                    {"coupled", declare_coupled(c)},
                                                    {"ensemble", declare_ensemble(c)}};
  for (auto& [name, keys] : models) {
    if (name == "vessel") append(keys, peridynamics::declare_start(c.vessel));
    if (name == "network") keys.push_back(output::declare_format(c.output));
    if (name != "ensemble") append(keys, insitu::declare(c.insitu));
  }
  std::string model = "vessel";
  for (const input::Entry& entry : document.entries) {
    if (entry.key != "scene.model") continue;
    if (const auto* text = std::get_if<std::string>(&entry.value.content)) model = *text;
  }
  const ParameterList* chosen = nullptr;
  for (const auto& [name, keys] : models) {
    if (name == model) chosen = &keys;
  }
  if (chosen == nullptr) return declare(c);  // the reader will refuse the model
  const auto has_section = [](const ParameterList& keys, const std::string& section) {
    const auto sections = input::sections_of(keys);
    return std::find(sections.begin(), sections.end(), section) != sections.end();
  };
  const auto has_key = [](const ParameterList& keys, const std::string& key) {
    return input::find(keys, key) != nullptr;
  };
  const auto refuse = [&](const std::string& place, const std::string& what, const std::string& name,
                          const auto& has) {
    if (has(*chosen, name)) return;
    std::string others;
    for (const auto& [other, keys] : models) {
      if (has(keys, name)) others += (others.empty() ? "\"" : ", \"") + other + '"';
    }
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
    if (model == "coupled" && network_knows(entry.key))
      throw InputError(document.place(entry) + ": the network says this of a coupled vessel");
    if (model == "coupled" && vessel_knows(entry.key))
      throw InputError(document.place(entry) + ": section [material] says this of a coupled network");
    refuse(document.place(entry), "this key", key, has_key);
  }
  ParameterList all = declare_scene(c);
  append(all, *chosen);
  return all;
}

bool network_knows(const std::string& key) {
  return input::section_of(key) == "vessel" || key == "load.pressure" || key == "load.table" ||
         key == "load.table_file" || key == "load.repeat" || key == "load.blood_density";
}

}  // namespace rhexis::app
