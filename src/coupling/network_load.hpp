// SPDX-License-Identifier: BSD-3-Clause
/// The load on a wall by the network that its vessel is part of.
#pragma once

#include <limits>

#include "coupling/coupled_vessel.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"

namespace rhexis::coupling {

/// Tells the network, at the end of every window, of lumen and opening, and loads the wall as it answers.
class NetworkLoad final : public peridynamics::LoadSource {
 public:
  /// `vessel` must live on; its wall has been extracted.
  explicit NetworkLoad(CoupledVessel& vessel) : vessel_(&vessel) {}
  void start(peridynamics::VesselSimulation& simulation) override;
  void at_moment(peridynamics::VesselSimulation& simulation) override;
  /// By the last exchange.
  double leak(const peridynamics::VesselSimulation&) const override { return vessel_->state().leak; }
  /// A network may also raise the load, where the lumen widens.
  double largest_share() const override { return std::numeric_limits<double>::max(); }

 private:
  CoupledVessel* vessel_;
};

}  // namespace rhexis::coupling
