// SPDX-License-Identifier: BSD-3-Clause
/// Tells when a wall begins to rupture.
#pragma once

#include <functional>
#include <utility>

#include "core/observer.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"

namespace rhexis::peridynamics {

/// Calls `tell` once, at the moment after the step that shows the onset, or at the end; not for an onset that
/// was known before.
class RuptureObserver final : public Observer {
 public:
  /// `simulation` must live on.
  RuptureObserver(const VesselSimulation& simulation, std::function<void(const RuptureEvents&)> tell)
      : simulation_(simulation), tell_(std::move(tell)), known_(simulation.rupture().onset.has_value()) {}
  void arrive(const Moment&) override { look(); }
  void end(const Moment&) override { look(); }

 private:
  void look() {
    if (known_ || !simulation_.rupture().onset) return;
    known_ = true;
    tell_(simulation_.rupture());
  }

  const VesselSimulation& simulation_;
  std::function<void(const RuptureEvents&)> tell_;
  bool known_;
};

}  // namespace rhexis::peridynamics
