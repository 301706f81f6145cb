// SPDX-License-Identifier: BSD-3-Clause
/// The flow in a network from its configuration to its results.
#pragma once

#include <memory>

#include "app/configuration.hpp"
#include "app/results.hpp"
#include "runtime/run_session.hpp"
#include "studies/flow/solved_network.hpp"

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
  std::unique_ptr<hemodynamics::FlowSolver> solver_;
  studies::SolvedNetwork network_;
};

}  // namespace rhexis::app
