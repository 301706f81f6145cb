// SPDX-License-Identifier: BSD-3-Clause
/// The time loop: steps a simulation under its load, and has observers follow it.
///
///     TimeLoop loop(simulation, load, {.steps = 1000});
///     EnergyBalance balance(simulation, {});
///     loop.subscribe(balance);
///     loop.run();
#pragma once

#include <functional>
#include <vector>

#include "core/observer.hpp"
#include "peridynamics/simulation/load_source.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"

namespace rhexis::peridynamics {

/// When the loop ends.
struct LoopPlan {
  long steps = 0;                ///< number of the last step
  bool ends_at_rupture = false;  ///< after the step that shows its onset
  /// The signal that asks this rank to end, below 60; 0 or no function: none. Asked once a step.
  std::function<int()> signal = {};
};

class TimeLoop {
 public:
  /// `simulation` and `load` must live on.
  TimeLoop(VesselSimulation& simulation, LoadSource& load, LoopPlan plan);

  /// `observer` must live on. The time that it takes is added to `seconds`, where that is given.
  void subscribe(Observer& observer, double* seconds = nullptr);
  /// The time that steps and loads take is added to `seconds` from now on.
  void count_solving(double& seconds) { seconds_ = &seconds; }

  /// Runs to the end; after a signal on any rank, to the moment that follows the step at hand. Returns that
  /// signal, or 0. Throws UnstableError, and what load and observers throw. Collective.
  int run();

 private:
  struct Subscription {
    Observer* observer;
    double* seconds;
  };

  template <class Call>
  void for_each_observer(const Call& call);
  void observe(const Moment& moment);
  int step(const Moment& moment);

  VesselSimulation& simulation_;
  LoadSource& load_;
  LoopPlan plan_;
  std::vector<Subscription> observers_;
  double unseen_ = 0;  ///< s, of what nobody counts
  double* seconds_ = &unseen_;
};

}  // namespace rhexis::peridynamics
