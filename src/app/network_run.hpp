/// The flow in a network from its configuration to its results.
#pragma once

#include <memory>
#include <optional>

#include "app/configuration.hpp"
#include "app/console.hpp"
#include "app/network_tier.hpp"
#include "app/run_options.hpp"
#include "insitu/pipeline.hpp"
#include "output/run_record.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::app {

/// As in run.json.
nlohmann::ordered_json to_json(const QueriedVessel& q);

class NetworkRun {
 public:
  NetworkRun(Configuration configuration, RunOptions options, parallel::Communicator comm);

  /// Throws RunError (after noting it in run.json) or InputError (nothing written).
  Ending run();

 private:
  void note_failure(const std::string& reason);
  void open_results();
  void say_header();
  void solve();
  void write_tables();
  void write_lines();
  void write_vtp();
  void draw();
  void say_summary();
  output::Performance performance() const;

  Configuration c_;
  RunOptions options_;
  parallel::Communicator comm_;
  Console console_;
  std::unique_ptr<NetworkTier> tier_;
  std::unique_ptr<insitu::Pipeline> pipeline_;
  std::string renderer_;
  std::optional<output::RunRecord> record_;
  NetworkSolution solution_;
  output::Results results_;
  struct {
    double solve = 0, output = 0, insitu = 0;  ///< s
  } spent_;
  double started_ = 0;
};

}  // namespace rhexis::app
