/// The flow in a network from its configuration to its results.
#pragma once

#include <memory>

#include "app/network_tier.hpp"
#include "app/run_base.hpp"

namespace rhexis::app {

class NetworkRun : private RunBase {
 public:
  NetworkRun(Configuration configuration, RunOptions options, parallel::Communicator comm);

  /// Throws RunError (after noting it in run.json) or InputError (nothing written).
  Ending run();

 private:
  void say_header();
  void solve();
  void draw();
  void say_summary();
  void say_screening();
  std::optional<double> network_flop() const override { return solution_.flop; }

  std::unique_ptr<NetworkTier> tier_;
  NetworkSolution solution_;
};

}  // namespace rhexis::app
