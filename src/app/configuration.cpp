// SPDX-License-Identifier: BSD-3-Clause
#include "app/configuration.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "app/scene_keys.hpp"
#include "core/error.hpp"
#include "core/memory.hpp"
#include "input/document.hpp"
#include "input/reader.hpp"
#include "parallel/node.hpp"
#include "parallel/together.hpp"
#include "runtime/version.hpp"
#include "scenes/pictures.hpp"
#include "scenes/scenes.hpp"

namespace rhexis::app {
namespace {

std::string read_on_root(const std::string& file, parallel::Communicator comm) {
  std::string text;
  parallel::on_root<InputError>(comm, [&] { text = input::read_text(file); });
  return comm.broadcast(text);
}

/// Memory that reading `text` takes, bytes. Throws InputError where there is not as much.
double reading_bytes(const std::string& text, const std::string& file, parallel::Communicator comm) {
  constexpr double of_a_character = 32;  // measured on a table of a million points
  const double bytes = of_a_character * static_cast<double>(text.size());
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

/// Who builds with a ParaView most likely looks at the files with it.
void warn_of_an_old_paraview(Configuration& c) {
  const std::string version = runtime::paraview_version();
  int major = 0, minor = 0;
  if (std::sscanf(version.c_str(), "%d.%d", &major, &minor) != 2 ||
      std::pair(major, minor) >= std::pair(5, 12))
    return;
  c.warnings.push_back(
      "output.format = \"" + std::string(name_of(c.output.format)) + "\": ParaView " + version +
      ", which Rhexis was built with, cannot read VTKHDF files of particles and networks; 5.12 "
      "and later can");
}

void resolve(Configuration& c, parallel::Communicator comm) {
  using scenes::Model;
  switch (c.model) {
    case Model::vessel:
      return scenes::resolve_vessel_scene(c, comm);
    case Model::network:
      return scenes::resolve_network(c, comm);
    case Model::coupled:
      return scenes::resolve_coupled_scene(c, comm);
    case Model::ensemble:
      return scenes::resolve_ensemble_scene(c, comm);
  }
}

}  // namespace

Configuration read_configuration(const std::string& file, const std::vector<std::string>& overrides,
                                 parallel::Communicator comm, Configuration c) {
  c.file = file;
  const std::string text = read_on_root(file, comm);
  c.input_bytes = reading_bytes(text, file, comm);
  parallel::together(comm, [&] {  // a rank may lack the database of units
    const input::Document document = input::parse_document(text, file, overrides);
    c.resolved = input::read(document, declare_model(c, document));
    c.warnings = c.resolved.warnings;
  });
  try {
    resolve(c, comm);
    const bool stores = c.model == scenes::Model::vessel ? !c.output.fields.empty() : !c.is_ensemble();
    if (stores && c.output.format != output::StoredAs::xdmf) warn_of_an_old_paraview(c);
    scenes::find_scripts(c, comm);
  } catch (const InputError& error) {
    throw input::located(error, c.resolved);
  }
  c.record = input::to_json(c.resolved);
  if (!c.table_checksum.empty()) c.record["load"]["table_file"]["checksum"] = c.table_checksum;
  return c;
}

}  // namespace rhexis::app
