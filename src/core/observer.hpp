// SPDX-License-Identifier: BSD-3-Clause
/// Whoever follows a simulation while it runs: history, fields, checkpoints, pictures, the balance of energy.
#pragma once

namespace rhexis {

/// A moment of a simulation: the state at a step's beginning, t_n.
struct Moment {
  long step = 0;
  double time_s = 0;
  bool first = false;  ///< the first moment of this run, which may go on from a checkpoint
  bool last = false;   ///< no step follows, for whatever reason
  int signal = 0;      ///< that ends the run with this moment; 0: none
};

/// Subscribes to a time loop, which calls it at every moment in the order of the functions below: each
/// function of all observers, in the order in which they subscribed, before the next function. All calls are
/// collective, and what they throw ends the run. What an observer looks at, it is given when it is made.
class Observer {
 public:
  virtual ~Observer() = default;
  /// The state is as the last step left it: the load has not answered to it yet.
  virtual void arrive(const Moment&) {}
  /// Whether this needs the fields at this moment. Evaluating them changes no results. The same on all ranks.
  virtual bool wants(const Moment&) { return false; }
  /// The fields are evaluated. Called where this wants them.
  virtual void observe(const Moment&) {}
  /// Some `observe` has failed with a RunError, which ends the run: the last chance to save the state.
  virtual void rescue(const Moment&) {}
  /// The run has ended with this moment, the last.
  virtual void end(const Moment&) {}
};

}  // namespace rhexis
