// SPDX-License-Identifier: BSD-3-Clause
/// One vessel from its configuration to its results: composes the simulation, its load and its observers.
#pragma once

#include <memory>
#include <optional>

#include "output/checkpoint.hpp"
#include "output/checkpoint_observer.hpp"
#include "output/field_observer.hpp"
#include "output/history.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"
#include "runtime/run_session.hpp"
#include "scenes/results.hpp"
#include "scenes/vessel/host_network.hpp"
#include "scenes/vessel/vessel_scene.hpp"
#include "studies/rupture/wall_checkpoint.hpp"

namespace rhexis::scenes {

/// Where `risk_of_load` knows it.
void print_risk(runtime::Console& console, const peridynamics::Parameters& vessel);

class VesselRun {
 public:
  /// `network`: the one that the vessel is part of; null: none. It must live on.
  VesselRun(VesselScene scene, runtime::RunOptions options, parallel::Communicator comm,
            HostNetwork* network = nullptr);
  ~VesselRun();

  /// Builds the wall and reads the checkpoint, where there is one; nothing is written. Done by `run` unless
  /// it was before. Throws InputError.
  void prepare();
  /// Runs to the end, or to the step after an interrupt. Throws RunError (after noting it in run.json) or
  /// InputError (nothing written).
  runtime::Ending run();

  const Results& results() const { return results_; }
  const runtime::Spent& spent() const { return session_.spent(); }

 private:
  void build();
  void open_results();
  std::optional<output::PointSeriesPlan> series_plan();
  void print_header();
  /// As the load means them: a dead one in both ways.
  std::string pressures_at_onset(double pressure, double blood_pressure, int digits) const;
  void print_onset(const peridynamics::RuptureEvents& rupture);
  void start_at_equilibrium();
  void time_loop();
  void note_results(const Moment& moment);
  Results results_so_far() const;
  void warn_of_odd_openings();
  output::CheckpointObserver::Plan checkpoint_plan();
  std::filesystem::path write_checkpoint(long step);
  void read_checkpoint();
  void compare_with(output::CheckpointReader& file);
  void print_summary();
  runtime::Work work() const;
  long step() const { return simulation_->step_number(); }

  VesselScene c_;
  parallel::Communicator comm_;
  Results results_;
  runtime::RunSession session_;
  HostNetwork* network_;
  std::unique_ptr<peridynamics::VesselSimulation> simulation_;
  std::unique_ptr<peridynamics::LoadSource> load_;
  std::optional<output::History> history_;
  std::optional<output::FieldObserver> fields_;

  studies::GivenWarnings given_warnings_;
  std::int64_t start_bond_evaluations_ = 0;
  long first_step_ = 0;
  int signal_ = 0;  ///< that has ended this run
};

/// One vessel alone. Throws as VesselRun::run. Collective.
runtime::Ending run(VesselScene scene, const runtime::RunOptions& options, parallel::Communicator comm);

}  // namespace rhexis::scenes
