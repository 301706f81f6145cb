// SPDX-License-Identifier: BSD-3-Clause
/// Probability of rupture against pressure: many vessels with scattered walls, shared among the ranks.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "output/atomic_file.hpp"
#include "runtime/run_session.hpp"
#include "scenes/configuration.hpp"
#include "scenes/results.hpp"
#include "studies/ensemble/probability.hpp"
#include "studies/ensemble/sample.hpp"

namespace rhexis::scenes {

/// Results are samples.csv, a row per vessel, kept while the run goes on, and probability.csv at its end. The
/// same run into the same folder goes on from the rows that are there. Rows and their order do not depend on
/// ranks, threads or restarts.
class EnsembleRun {
 public:
  EnsembleRun(Configuration configuration, runtime::RunOptions options, parallel::Communicator comm);

  /// Throws RunError (after noting it in run.json) or InputError (nothing written).
  runtime::Ending run();

 private:
  using Task = std::pair<std::int64_t, double>;  ///< wall, pressure

  void read_earlier();
  void plan();
  void open_results();
  void print_header();
  void run_samples();
  int run_round(std::size_t first, std::size_t count);
  void keep(const std::vector<ensemble::Sample>& finished);
  void finish();
  void print_summary();

  Configuration c_;
  parallel::Communicator comm_;
  Results results_;
  runtime::RunSession session_;
  std::vector<ensemble::Sample> samples_;  ///< all that are known, on every rank
  std::vector<Task> tasks_;                ///< samples to do
  std::vector<ensemble::Probability> probabilities_;
  output::TableFile table_;
  int signal_ = 0;           ///< that ended it
  std::size_t earlier_ = 0;  ///< samples that an earlier run had done
  double sample_s_ = 0;      ///< spent in samples by this rank
  std::int64_t bond_evaluations_ = 0;
};

}  // namespace rhexis::scenes
