// SPDX-License-Identifier: BSD-3-Clause
/// A coupled scene's network and one of its vessels: the network is solved, its vessel chosen, and its wall
/// resolved.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "coupling/coupled_vessel.hpp"
#include "output/checkpoint.hpp"
#include "output/results_folder.hpp"
#include "runtime/console.hpp"
#include "scenes/coupled/coupled_scene.hpp"
#include "scenes/vessel/host_network.hpp"
#include "studies/cascade/cascade_state.hpp"
#include "studies/flow/solved_network.hpp"

namespace rhexis::scenes {

class NetworkCoupling final : public HostNetwork {
 public:
  /// Solves the network and chooses its vessel: in a cascade with what the events so far left of it, else
  /// `cascade` is null; it must live on. Nothing is written. Collective. Throws InputError and RunError.
  NetworkCoupling(const CoupledScene& scene, const studies::CascadeState* cascade, const Reading& reading,
                  runtime::Console& console);

  /// No vessel's risk is above the cascade's limit: there is nothing to simulate.
  bool at_rest() const { return at_rest_; }
  /// The vessel that is simulated; where nothing is, the one at highest risk, if there is one.
  const hemodynamics::NetworkVessel& chosen() const { return chosen_; }
  double risk() const { return risk_; }  ///< the vessel's risk (studies/screening/screening.hpp)
  const hemodynamics::NetworkFlow& flow() const { return network_.flow(); }

  /// That vessel as a scene, with its load and its wall, resolved; `coupled()` is there from then on.
  /// Collective. Throws InputError, complete with place.
  VesselScene make_vessel();
  coupling::CoupledVessel& coupled() { return *coupled_; }
  const coupling::CoupledVessel& coupled() const { return *coupled_; }

  /// Writes the network's files.
  void write(const output::ResultsFolder& folder);

  std::unique_ptr<peridynamics::LoadSource> load() override;
  void start(peridynamics::VesselSimulation& simulation) override;
  std::unique_ptr<Observer> observer(const peridynamics::VesselSimulation& simulation, bool& told,
                                     std::function<void(const std::string&)> warn) override;
  void finish(double time_s) override { coupled_->count_leak(time_s); }
  void open(const output::ResultsFolder& folder) override;
  /// In a cascade with the cascade's state.
  void save(output::CheckpointWriter& file) const override;
  void restore(output::CheckpointReader& file, double time_s,
               const std::filesystem::path& directory) override;
  /// With the vessel's place, pressure and leak.
  LineSource& lines(long step, double time_s) override;
  std::optional<double> flop() const override { return flow().flop; }
  nlohmann::ordered_json network_record() const override;
  nlohmann::ordered_json results() const override;
  void print_header(runtime::Console& console, double time_step) const override;
  void print_summary(runtime::Console& console) const override;

 private:
  void find_named_vessel();
  void choose();

  CoupledScene scene_;
  const studies::CascadeState* cascade_;
  Reading reading_;
  hemodynamics::FlowProblem problem_;  ///< with what the events so far left
  studies::ScreeningPlan screening_;
  std::unique_ptr<hemodynamics::FlowSolver> solver_;
  studies::SolvedNetwork network_;
  std::optional<std::int64_t> named_;  ///< number of coupling.vessel, where it is named
  hemodynamics::NetworkVessel chosen_;
  std::optional<coupling::CoupledVessel> coupled_;
  bool at_rest_ = false;
  double risk_ = 0, network_s_ = 0;
};

}  // namespace rhexis::scenes
