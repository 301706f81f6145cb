// SPDX-License-Identifier: BSD-3-Clause
/// The network that a vessel is part of, as the run of the vessel knows it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/field_view.hpp"
#include "core/observer.hpp"
#include "output/checkpoint.hpp"
#include "output/results_folder.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"
#include "runtime/console.hpp"

namespace rhexis::scenes {

class HostNetwork {
 public:
  virtual ~HostNetwork() = default;

  /// What loads the wall; null: its schedule does, and what the opening lets go.
  virtual std::unique_ptr<peridynamics::LoadSource> load() = 0;
  /// Gives a wall that has not moved the network's load along its axis.
  virtual void start(peridynamics::VesselSimulation& simulation) = 0;
  /// What looks at the coupled simulation. `told`: whether the user has been warned, also by a run that this
  /// one goes on from; it and `simulation` must live on.
  virtual std::unique_ptr<Observer> observer(const peridynamics::VesselSimulation& simulation, bool& told,
                                             std::function<void(const std::string&)> warn) = 0;
  /// The wall's time is over.
  virtual void finish(double time_s) = 0;

  /// Writes the network's files and begins or continues the table of exchanges. Collective.
  virtual void open(const output::ResultsFolder& folder) = 0;
  virtual void save(output::CheckpointWriter& file) const = 0;
  /// Goes on from a checkpoint at `time_s`; reads what there is of tables in `directory`. Throws InputError.
  virtual void restore(output::CheckpointReader& file, double time_s,
                       const std::filesystem::path& directory) = 0;

  /// The network as it is shown at a moment.
  virtual LineSource& lines(long step, double time_s) = 0;
  virtual std::optional<double> flop() const = 0;  ///< operations that its flow took, where they are counted
  virtual nlohmann::ordered_json network_record() const = 0;
  virtual nlohmann::ordered_json results() const = 0;
  virtual void print_header(runtime::Console& console, double time_step) const = 0;
  virtual void print_summary(runtime::Console& console) const = 0;
};

}  // namespace rhexis::scenes
