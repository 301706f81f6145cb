// SPDX-License-Identifier: BSD-3-Clause
/// Writes history.csv of a wall while its simulation goes on.
#pragma once

#include <span>
#include <utility>

#include "core/observer.hpp"
#include "output/history.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"

namespace rhexis::studies {

/// Appends a row at `steps` (ascending) and at the end.
class HistoryObserver final : public Observer {
 public:
  /// What the references and `steps` refer to must live on; `load` loads the wall of `simulation`.
  HistoryObserver(peridynamics::VesselSimulation& simulation, const peridynamics::LoadSource& load,
                  output::History history, std::span<const long> steps)
      : simulation_(simulation), load_(load), history_(std::move(history)), steps_(steps) {}
  bool wants(const Moment& moment) override;
  void observe(const Moment& moment) override;

 private:
  peridynamics::VesselSimulation& simulation_;
  const peridynamics::LoadSource& load_;
  output::History history_;
  std::span<const long> steps_;
};

}  // namespace rhexis::studies
