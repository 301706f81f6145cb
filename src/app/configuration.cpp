// SPDX-License-Identifier: BSD-3-Clause
#include "app/configuration.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "app/scene_keys.hpp"
#include "core/memory.hpp"
#include "input/document.hpp"
#include "input/reader.hpp"
#include "parallel/node.hpp"
#include "parallel/together.hpp"

namespace rhexis::app {
namespace {

std::string read_on_root(const std::string& file, parallel::Communicator comm) {
  std::string text;
  parallel::on_root<InputError>(comm, [&] { text = input::read_text(file); });
  return comm.broadcast(text);
}

/// Memory that reading `text` takes, bytes. Throws InputError where there is not as much.
double reading_bytes(const std::string& text, const std::string& file, parallel::Communicator comm) {
  const double bytes = input::parsing_bytes(text.size());
  const MemoryLimit limit = available_memory();
  const double here = limit.of_machine ? parallel::ranks_of_node(comm) : 1;
  parallel::together<InputError>(comm, [&] {
    if (here * bytes <= limit.bytes) return;
    throw InputError(fmt::format(
        "{}: to read its {:.3g} MB of text takes {:.3g} GB of memory, and {:.3g} GB are left by {}; a long "
        "table belongs in a CSV file (load.table_file)",
        file, 1e-6 * static_cast<double>(text.size()), 1e-9 * here * bytes, 1e-9 * limit.bytes,
        limit.source));
  });
  return bytes;
}

/// The scene of the document with all values read, not resolved.
Configuration scene_of(const input::Document& document) {
  std::optional<Configuration> scene = scene_named(document);
  if (!scene) {
    input::read(document, AllKeys().list());  // refuses the value of scene.model
    throw InputError(document.file + ": there is no such scene.model");
  }
  std::string model = model_of(*scene);
  const ParameterList keys = declare(*scene, model);
  refuse_keys_of_other_kinds(document, keys, model);
  scenes::SceneInput& input = input_of(*scene);
  input.file = document.file;
  input.resolved = input::read(document, keys);
  input.warnings = input.resolved.warnings;
  return std::move(*scene);
}

}  // namespace

Configuration read_configuration(const std::string& file, const std::vector<std::string>& overrides,
                                 scenes::Reading& reading) {
  const std::string text = read_on_root(file, reading.comm);
  reading.input_bytes = reading_bytes(text, file, reading.comm);
  Configuration scene;
  parallel::together(reading.comm, [&] {  // a rank may lack the database of units
    scene = scene_of(input::parse_document(text, file, overrides));
  });
  scenes::with_place(input_of(scene),
                     [&] { std::visit([&](auto& s) { scenes::resolve(s, reading); }, scene); });
  return scene;
}

}  // namespace rhexis::app
