// SPDX-License-Identifier: BSD-3-Clause
/// The whole input of a run, typed: what the reader fills and the rest of the program builds from.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "coupling/parameters.hpp"
#include "hemodynamics/parameters.hpp"
#include "input/reader.hpp"
#include "insitu/parameters.hpp"
#include "network/parameters.hpp"
#include "output/parameters.hpp"
#include "parallel/communicator.hpp"
#include "peridynamics/parameters.hpp"
#include "peridynamics/wall_model.hpp"
#include "studies/ensemble/parameters.hpp"
#include "studies/screening/parameters.hpp"

namespace rhexis::scenes {

/// What a scene simulates.
enum class Model { vessel, network, coupled, ensemble };

constexpr auto name_table(Model) {
  using enum Model;
  return std::to_array<Named<Model>>(
      {{vessel, "vessel"}, {network, "network"}, {coupled, "coupled"}, {ensemble, "ensemble"}});
}

struct Configuration {
  std::string file;
  std::string title;
  Model model = Model::vessel;
  peridynamics::Parameters vessel;  ///< as read
  network::Parameters network;
  hemodynamics::Parameters hemodynamics;
  screening::Parameters screening;
  coupling::Parameters coupling;
  ensemble::Parameters ensemble;
  output::Parameters output;
  insitu::Parameters insitu;

  network::TreeRules tree;  ///< where network.source = "tree"

  bool is_coupled() const { return model == Model::coupled; }
  bool is_ensemble() const { return model == Model::ensemble; }

  /// What `vessel` is resolved to, an ensemble's mean wall; none of a network, or before a coupled vessel is
  /// known.
  peridynamics::SharedWall wall;

  double input_bytes = 0;  ///< memory that reading the input file takes

  std::vector<long> output_steps;
  std::string table_checksum;  ///< of load.table_file; empty: none was read
  std::vector<std::string> warnings;
  std::string no_pictures;        ///< why there can be none, where scripts are named; else empty
  input::Resolved resolved;       ///< for messages about values that do not fit together
  nlohmann::ordered_json record;  ///< as resolved, for run.json

  bool checks = false;  ///< `rhexis check`, and no run
  /// Tells the user, at the terminal, of what takes a while or is to be known before it is done; may be
  /// empty. A label and a text as runtime::Console::item has them, or no label.
  std::function<void(const std::string& label, const std::string& text)> say;
};

/// Makes the wall of a coupled vessel, once the network has given its geometry and its load. Throws
/// InputError, complete with place. Collective.
void resolve_coupled_wall(Configuration& c, parallel::Communicator comm);

/// The risk (studies/screening/screening.hpp) of a wall without spots or scatter under its schedule's highest
/// pressure; none of a wall that stiffens.
std::optional<double> risk_of_load(const peridynamics::Parameters& vessel);

}  // namespace rhexis::scenes
