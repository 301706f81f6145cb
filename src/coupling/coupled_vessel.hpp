// SPDX-License-Identifier: BSD-3-Clause
/// A vessel of a network and its wall, coupled (Sec. 3.3): the network loads the wall and, in two-way
/// coupling, hears of its lumen and its leak at the end of every window.
///
///     CoupledVessel vessel(...);                       // the load on the intact vessel, Eq. (7)
///     peridynamics::Parameters wall = vessel.extract_wall(input);  // the segment that is simulated
///     vessel.set_windows(wall_resolved, time_step);
///     for (...) if (vessel.due(step)) vessel.exchange({...});
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "coupling/surroundings.hpp"
#include "coupling/wall_segment.hpp"
#include "hemodynamics/steady/bleeding.hpp"
#include "hemodynamics/steady/flow_solver.hpp"
#include "output/atomic_file.hpp"
#include "output/checkpoint.hpp"
#include "output/results_folder.hpp"

namespace rhexis::coupling {

/// The name by which checkpoints of a coupled vessel hold the vessel's name in its network.
inline constexpr const char* coupled_vessel_name = "coupled_vessel";
/// The table of the exchanges of two-way coupling.
inline constexpr const char* exchange_table_name = "coupling.csv";

/// Whether two solutions of one network agree: on another kind of processor their last digits may differ.
bool agree(double a, double b);

/// What the exchange has come to; on all ranks.
struct ExchangeState {
  AxialLoad load;               ///< net pressures at full schedule, Pa
  double leak = 0;              ///< m3/s, by the last exchange
  double leaked = 0;            ///< m3, until `last_time`
  double last_time = 0;         ///< s
  double worst_imbalance = 0;   ///< relative to the inflow, of all exchanges
  double schedule = 1;          ///< share of the network's pressures that acts
  double highest_reynolds = 0;  ///< number, of the flow at the vessel's ends, with the viscosity of all blood
  std::int64_t windows = 0;
};

/// Gives a vessel whose radius varies along it the radius that its straight wall is to have, with the
/// thickness of the wall there.
void set_radius(hemodynamics::NetworkVessel& vessel, RadiusOf which);

class CoupledVessel {
 public:
  /// The vessel `vessel` of a network that `solver` has solved, and the load on it while it is intact;
  /// `solver` must live on. Adds to `warnings`. Collective. Throws InputError.
  CoupledVessel(const Parameters& p, const hemodynamics::FlowProblem& problem, double discharge_coefficient,
                const hemodynamics::FlowSolver& solver, const hemodynamics::NetworkDisplay& display,
                hemodynamics::NetworkVessel vessel, parallel::Communicator comm,
                std::vector<std::string>& warnings);

  const hemodynamics::NetworkVessel& vessel() const { return chosen_; }
  bool two_way() const { return p_.two_way(); }

  /// The parameters of the input, which are not resolved yet, with geometry, strength and load of the segment
  /// of its wall that is simulated. Throws InputError.
  peridynamics::Parameters extract_wall(peridynamics::Parameters wall);
  const WallSegment& segment() const { return segment_; }
  /// Settles the windows of the exchange for a resolved wall. Adds to `warnings`. Throws InputError.
  void set_windows(const peridynamics::Parameters& wall, double time_step,
                   std::vector<std::string>& warnings);
  long steps_per_window() const { return steps_per_window_; }

  /// The opening of the wall as seen from the network, area in m2.
  hemodynamics::Orifice orifice(double opening) const;
  /// Largest net pressure on the simulated wall by the last exchange, Pa; `profile` is relative to it.
  double pressure() const { return largest_load(state_.load, data_, segment_); }
  /// The same before the vessel ruptures: by the network's first solution.
  double intact_pressure() const { return largest_load(intact_load_, data_, segment_); }
  const AxialLoad& intact_load() const { return intact_load_; }
  /// The net pressure at a height (m) of the simulated wall over `pressure()`.
  std::function<double(double z)> profile() const;

  /// Whether a window ends at this step.
  bool due(long step) const { return two_way() && step % steps_per_window_ == 0; }
  /// What the wall is like at the end of a window.
  struct Wall {
    double time_s = 0;
    double schedule = 0;           ///< share of the network's pressures that acts now
    double opening = 0;            ///< m2
    double resistance_factor = 1;  ///< flow resistance of the deformed lumen over that of the undeformed one
  };
  /// Solves the network anew around the vessel. Collective.
  void exchange(const Wall& wall);
  /// Counts what leaks until then.
  void count_leak(double time_s);
  const ExchangeState& state() const { return state_; }
  double exchange_seconds() const { return exchange_s_; }

  /// Begins coupling.csv where coupling is two-way, or continues it after `restore`. Collective.
  void open_table(const output::ResultsFolder& folder);
  /// What a restart needs beside the input, from which the network is solved anew: the exchange so far, and
  /// what the network was like, to be compared. `inflow`: of the network, m3/s. Collective.
  void save(output::CheckpointWriter& file, double inflow) const;
  /// Goes on from there at `time_s`; reads what there is of coupling.csv in `directory`. Throws InputError
  /// where the vessel is another one, or, in two-way coupling or where `compares_load`, where the network is
  /// not as it was. Collective.
  void restore(output::CheckpointReader& file, double inflow, bool compares_load, double time_s,
               const std::filesystem::path& directory);

  /// Names and values for run.json.
  nlohmann::ordered_json results(double network_seconds) const;

 private:
  void find_load(const std::array<double, 3>& heart);
  void compare_with(output::CheckpointReader& file, double inflow, bool compares_load) const;

  Parameters p_;
  hemodynamics::Parameters blood_;
  double discharge_coefficient_;
  parallel::Communicator comm_;
  hemodynamics::NetworkVessel chosen_;
  std::unique_ptr<hemodynamics::VesselInNetwork> in_network_;
  VesselData data_;
  WallSegment segment_;
  /// At the vessel's beginning, middle and end; the heart's by the last exchange.
  std::array<PressureParts, 3> parts_{};
  AxialLoad intact_load_;
  ExchangeState state_;
  long steps_per_window_ = 1;
  double exchange_s_ = 0;
  std::string kept_table_;  ///< what a restart keeps of coupling.csv; of the first rank
  output::TableFile table_;
};

}  // namespace rhexis::coupling
