/// What every run has, whatever it simulates: options, terminal, clock, results and their record.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/configuration.hpp"
#include "app/console.hpp"
#include "app/interrupt.hpp"
#include "app/pictures.hpp"
#include "app/run_options.hpp"
#include "output/machine.hpp"
#include "output/results_folder.hpp"
#include "output/run_record.hpp"
#include "parallel/communicator.hpp"
#include "parallel/halo.hpp"

namespace rhexis::app {

/// What is run, and from what file: the first that a run says.
void say_title(Console& console, const Configuration& c);
/// Where `risk_of_load` knows it.
void say_risk(Console& console, const peridynamics::Parameters& vessel);

class RunBase {
 protected:
  struct Spent {
    double solve = 0, output = 0, insitu = 0;  ///< s
    void add(const Spent& other) {
      solve += other.solve;
      output += other.output;
      insitu += other.insitu;
    }
  };

  RunBase(Configuration configuration, RunOptions options, parallel::Communicator comm);
  ~RunBase() = default;

  /// Takes the folder of results for this run, which changes nothing in it but for new folders: first of all,
  /// so that nothing is computed in vain. Throws InputError.
  void open_folder(output::FolderPlan plan);
  void open_folder();
  /// The results of earlier runs go, and run.json begins: once all that may be wrong with the input is known.
  /// `first_step` is that of options_.restart.
  void open_record(std::optional<std::int64_t> first_step = {});
  /// Does `work`, which returns the signal that ended it or 0, and tells run.json how it ended. What is found
  /// to be wrong with the input once run.json has begun is a failure of the run.
  Ending recorded(const std::function<int()>& work);
  /// Starts ParaView, or settles why there will be no pictures. Collective. Throws InputError for a bad
  /// script.
  void start_insitu();
  /// Ends ParaView, unless other runs still need it.
  void finish_insitu();
  void make_movie();
  /// Collective.
  output::Performance performance();
  /// Directed bond evaluations so far, on this rank; none where no wall is simulated.
  virtual std::optional<std::int64_t> bond_evaluations() const { return {}; }
  /// Of halos so far, on this rank; none where no wall is dealt out to ranks.
  virtual std::optional<parallel::Traffic> traffic() const { return {}; }
  /// Floating-point operations of a network so far, on all ranks; none where nobody counts.
  virtual std::optional<double> network_flop() const { return {}; }

  /// To the terminal and to run.json.
  void warn(const std::string& text);
  /// First lines of the header: program, title, warnings, input.
  void say_input();
  void say_warnings();
  /// Last lines of the header: ranks and threads, who draws, results.
  void say_surroundings();
  /// Last lines of the summary.
  void say_cost(const output::Performance& p);

  Configuration c_;
  RunOptions options_;
  std::optional<output::ResultsFolder> folder_;
  parallel::Communicator comm_;
  Console console_;
  std::optional<output::RunRecord> record_;
  std::optional<SignalWatch> signals_;
  output::Results results_;
  Spent spent_;
  std::shared_ptr<Pictures> pictures_;
  output::EnergyMeter energy_;

 private:
  void note_failure(const std::string& reason);
  std::optional<double> energy_of_nodes();

  double started_;  ///< s, of the clock
};

}  // namespace rhexis::app
