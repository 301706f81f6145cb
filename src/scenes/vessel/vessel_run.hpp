// SPDX-License-Identifier: BSD-3-Clause
/// One vessel from its configuration to its results: owns the time loop and the observers.
#pragma once

#include <memory>
#include <optional>

#include "output/checkpoint.hpp"
#include "output/history.hpp"
#include "output/point_series.hpp"
#include "peridynamics/monitors/particle_source.hpp"
#include "peridynamics/simulation/vessel_simulation.hpp"
#include "runtime/run_session.hpp"
#include "scenes/coupled/network_coupling.hpp"
#include "scenes/results.hpp"

namespace rhexis::scenes {

/// Where `risk_of_load` knows it.
void print_risk(runtime::Console& console, const peridynamics::Parameters& vessel);

class VesselRun {
 public:
  /// `coupling`: the network that the vessel is part of, which the scene comes from.
  VesselRun(VesselScene scene, runtime::RunOptions options, parallel::Communicator comm,
            NetworkCoupling* coupling = nullptr);
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
  std::string unstable_message(long step, const std::string& sign) const;
  void build();
  void open_results();
  void print_header();
  void start_at_equilibrium();
  void time_loop();
  void check_balance(long step, const peridynamics::Totals& t) const;
  bool balance_due(long step) const;
  void warn_of_crushed_bonds(long step, const peridynamics::Totals& t);
  void warn_of_turbulence();
  void warn_of_odd_openings();
  void observe(long step, bool with_output, bool with_pictures);
  void show(bool with_output, bool with_pictures);
  bool output_due(long step) const;
  bool pictures_due(long step, bool with_output);
  void record_events(const peridynamics::VesselSimulation::Report& report);
  void write_checkpoint(long step);
  void read_checkpoint();
  void compare_with(output::CheckpointReader& file);
  template <class Visit>
  void for_each_number(peridynamics::Body::Saved& saved, peridynamics::RuptureEvents& rupture,
                       peridynamics::LoadState& load, const Visit& visit);
  void print_summary();
  runtime::Work work() const;
  long step() const { return simulation_->step_number(); }

  VesselScene c_;
  parallel::Communicator comm_;
  Results results_;
  runtime::RunSession session_;
  NetworkCoupling* coupling_;
  std::unique_ptr<peridynamics::VesselSimulation> simulation_;
  std::unique_ptr<peridynamics::LoadSource> load_;
  std::unique_ptr<peridynamics::ParticleSource> source_;
  std::optional<output::PointSeries> series_;
  std::optional<output::History> history_;

  std::filesystem::path last_checkpoint_;  ///< that this run has written
  std::int64_t start_bond_evaluations_ = 0;
  long first_step_ = 0;
  int signal_ = 0;  ///< that asks this run to end
  bool crushing_was_told_ = false, turbulence_was_told_ = false;
};

/// One vessel alone. Throws as VesselRun::run. Collective.
runtime::Ending run(VesselScene scene, const runtime::RunOptions& options, parallel::Communicator comm);

}  // namespace rhexis::scenes
