// SPDX-License-Identifier: BSD-3-Clause
/// The flow in a network from its configuration to its results.
#pragma once

#include <memory>

#include "runtime/run_session.hpp"
#include "scenes/configuration.hpp"
#include "scenes/results.hpp"
#include "studies/flow/solved_network.hpp"

namespace rhexis::scenes {

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

}  // namespace rhexis::scenes
