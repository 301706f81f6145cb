// SPDX-License-Identifier: BSD-3-Clause
/// Warns where the flow in a torn vessel is not laminar any more.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "core/observer.hpp"
#include "coupling/coupled_vessel.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"

namespace rhexis::coupling {

/// Looks at the end of every window, from the onset of rupture on, and warns once.
class TurbulenceObserver final : public Observer {
 public:
  /// `told`: whether the user has been warned, also by a run that this one goes on from. What it and the
  /// others refer to must live on.
  TurbulenceObserver(const peridynamics::VesselSimulation& simulation, const CoupledVessel& vessel,
                     bool& told, std::function<void(const std::string&)> warn)
      : simulation_(simulation), vessel_(vessel), told_(told), warn_(std::move(warn)) {}
  bool wants(const Moment& moment) override;
  void observe(const Moment& moment) override;

 private:
  const peridynamics::VesselSimulation& simulation_;
  const CoupledVessel& vessel_;
  bool& told_;
  std::function<void(const std::string&)> warn_;
};

}  // namespace rhexis::coupling
