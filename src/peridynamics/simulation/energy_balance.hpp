// SPDX-License-Identifier: BSD-3-Clause
/// Observers that look for a time step that is too long: by the energy that the wall holds, and by bonds that
/// are compressed beyond what the stable time step was found for.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "core/error.hpp"
#include "core/observer.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"

namespace rhexis::peridynamics {

/// The state is of no use any more. The message tells the user of `sign` and of a time step that is stable.
struct UnstableError : RunError {
  UnstableError(const VesselSimulation& simulation, const std::string& sign);
  long step;  ///< by which it was seen
};

/// Throws UnstableError where the wall holds more energy than the load has put in
/// (`holds_no_more_than_was_put_in`). Looks at `steps` (ascending), at the end, and 1, 2, 4, ... steps after
/// the first break: a wall that an unstable step tears is not to pass for a rupture until the next output.
class EnergyBalance final : public Observer {
 public:
  /// What `simulation` and `steps` refer to must live on.
  EnergyBalance(VesselSimulation& simulation, std::span<const long> steps)
      : simulation_(simulation), steps_(steps) {}
  bool wants(const Moment& moment) override;
  void observe(const Moment& moment) override;

 private:
  VesselSimulation& simulation_;
  std::span<const long> steps_;
};

/// Warns once of bonds that are compressed to less than half their length: they cost accuracy, which the
/// balance of energy shows, before they cost stability. Looks at `steps` (ascending) and at the end.
class CrushedBonds final : public Observer {
 public:
  /// `told`: whether the user has been warned, also by a run that this one goes on from. What it and the
  /// others refer to must live on.
  CrushedBonds(VesselSimulation& simulation, std::span<const long> steps, bool& told,
               std::function<void(const std::string&)> warn)
      : simulation_(simulation), steps_(steps), told_(told), warn_(std::move(warn)) {}
  bool wants(const Moment& moment) override;
  void observe(const Moment& moment) override;

 private:
  VesselSimulation& simulation_;
  std::span<const long> steps_;
  bool& told_;
  std::function<void(const std::string&)> warn_;
};

}  // namespace rhexis::peridynamics
