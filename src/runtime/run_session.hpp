// SPDX-License-Identifier: BSD-3-Clause
/// What every run has, whatever it simulates: options, terminal, clock, the folder of results with their
/// record, and pictures.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output/machine.hpp"
#include "output/results_folder.hpp"
#include "output/run_record.hpp"
#include "parallel/communicator.hpp"
#include "parallel/halo.hpp"
#include "runtime/console.hpp"
#include "runtime/interrupt.hpp"
#include "runtime/performance.hpp"
#include "runtime/pictures.hpp"
#include "runtime/run_description.hpp"
#include "runtime/run_options.hpp"

namespace rhexis::runtime {

/// What has been computed so far; nothing where nobody counts.
struct Work {
  /// Directed evaluations of bonds by this rank, and what one takes, FLOP.
  std::optional<std::int64_t> bond_evaluations = {};
  double flop_per_evaluation = 0;
  std::optional<parallel::Traffic> traffic = {};  ///< bytes and messages of this rank's halos
  std::optional<double> network_flop = {};        ///< FLOP of a network's flow, on all ranks
};

/// What run.json is told of a run, whenever it is written.
struct RunState {
  std::function<output::Values()> results;
  std::function<Work()> work;
};

/// Seconds by what they were spent on.
struct Spent {
  double solve = 0, output = 0, insitu = 0;
  void add(const Spent& other) {
    solve += other.solve;
    output += other.output;
    insitu += other.insitu;
  }
};

/// The first lines of a run's header: program, title and input file.
void print_title(Console& console, const std::string& title, const std::string& file);

class RunSession {
 public:
  RunSession(RunDescription description, RunOptions options, parallel::Communicator comm, RunState state);

  const RunOptions& options() const { return options_; }
  bool restarts() const { return !options_.restart.empty(); }
  Console& console() { return console_; }
  const output::ResultsFolder& folder() const { return *folder_; }
  output::RunRecord& record() { return *record_; }
  Spent& spent() { return spent_; }
  const Spent& spent() const { return spent_; }
  /// Also for runs that this one is made of; filled by `start_pictures`.
  const std::shared_ptr<Pictures>& pictures() const { return pictures_; }

  /// Takes the folder of results for this run, which changes nothing in it but for new folders: first of all,
  /// so that nothing is computed in vain. Throws InputError.
  void open_folder(const output::FolderPlan& plan);
  /// The results of earlier runs go, and run.json begins: once all that may be wrong with the input is known.
  /// `first_step` is that of options().restart.
  void open_record(std::optional<std::int64_t> first_step = {});
  /// Does `work`, which returns the signal that ended it or 0, and tells run.json how it ended. What is found
  /// to be wrong with the input once run.json has begun is a failure of the run.
  Ending recorded(const std::function<int()>& work);
  /// Starts ParaView, or says why there will be no pictures. Collective. Throws InputError for a bad script.
  void start_pictures();
  /// Ends ParaView, unless other runs still need it.
  void finish_pictures();
  void make_movie();
  /// Collective.
  Performance performance();

  /// To the terminal and to run.json.
  void warn(const std::string& text);
  void warn(const std::vector<std::string>& texts);
  void print_title() { runtime::print_title(console_, description_.title, description_.file); }
  /// Last lines of the header: ranks and threads, who draws, results.
  void print_surroundings();
  /// Last lines of the summary.
  void print_cost(const Performance& p);

 private:
  void note_failure(const std::string& reason);
  std::optional<double> energy_of_nodes();

  RunDescription description_;
  RunOptions options_;
  parallel::Communicator comm_;
  RunState state_;
  std::optional<output::ResultsFolder> folder_;
  Console console_;
  std::optional<output::RunRecord> record_;
  std::optional<SignalWatch> signals_;
  Spent spent_;
  std::shared_ptr<Pictures> pictures_;
  output::EnergyMeter energy_;
  double started_;  ///< s, of the clock
};

}  // namespace rhexis::runtime
