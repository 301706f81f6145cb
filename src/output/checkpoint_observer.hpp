// SPDX-License-Identifier: BSD-3-Clause
/// When a run writes checkpoints; what they hold is in another's hands (checkpoint.hpp).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include "core/observer.hpp"

namespace rhexis::output {

/// Writes a checkpoint every so many steps, where a signal ends the run, and where a moment cannot be stored
/// or drawn, so that nothing is lost.
class CheckpointObserver final : public Observer {
 public:
  struct Plan {
    long every = 0;  ///< steps; 0: only where the run ends before its time
    /// Writes the checkpoint of the present moment and returns its path. Collective. Throws RunError.
    std::function<std::filesystem::path(long step)> write = {};
    /// Tells that a signal ends the run, which goes on from this checkpoint.
    std::function<void(int signal, const std::filesystem::path&)> interrupted = {};
    /// Tells that the run has failed and goes on from this checkpoint.
    std::function<void(const std::filesystem::path&)> failed = {};
    /// Tells why a run that has failed leaves no checkpoint.
    std::function<void(const std::string& reason)> warn = {};
  };
  explicit CheckpointObserver(Plan plan) : plan_(std::move(plan)) {}

  /// First of all that happens at a moment: a launcher that was interrupted may not leave time for more.
  void arrive(const Moment& moment) override;
  void rescue(const Moment& moment) override;

 private:
  Plan plan_;
};

}  // namespace rhexis::output
