/// The flow in a network from its configuration to its results.
#pragma once

#include <memory>

#include "app/network_tier.hpp"
#include "app/results.hpp"
#include "runtime/run_session.hpp"

namespace rhexis::app {

class NetworkRun {
 public:
  NetworkRun(Configuration configuration, runtime::RunOptions options, parallel::Communicator comm);

  /// Throws RunError (after noting it in run.json) or InputError (nothing written).
  runtime::Ending run();

 private:
  void print_header();
  void solve();
  void draw();
  void print_summary();
  void print_screening();

  Configuration c_;
  parallel::Communicator comm_;
  Results results_;
  runtime::RunSession session_;
  std::unique_ptr<NetworkTier> tier_;
  NetworkSolution solution_;
};

}  // namespace rhexis::app
