/// A network and one of its vessels, coupled (Sec. 3.3): loads the wall, and in two-way coupling hears of its
/// lumen and its leak.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/cascade_state.hpp"
#include "app/configuration.hpp"
#include "app/results.hpp"
#include "coupling/net_pressure.hpp"
#include "coupling/wall_segment.hpp"
#include "output/atomic_file.hpp"
#include "output/checkpoint.hpp"
#include "output/results_folder.hpp"
#include "runtime/console.hpp"
#include "studies/flow/solved_network.hpp"

namespace rhexis::app {

class NetworkCoupling {
 public:
  /// Solves the network and chooses its vessel. Nothing is written. Collective. Throws InputError and
  /// RunError.
  NetworkCoupling(const Configuration& c, parallel::Communicator comm, runtime::Console& console);

  /// No vessel's risk is above the cascade's limit: there is nothing to simulate, nor to hand over.
  bool at_rest() const { return at_rest_; }
  /// Once, before anything is exchanged: the configuration with that vessel, its load and its wall, resolved.
  /// Collective. Throws InputError.
  const Configuration& hand_over();
  const hemodynamics::NetworkVessel& vessel() const { return chosen_; }
  double risk() const { return risk_; }  ///< of that vessel (studies/screening/screening.hpp)
  double inflow() const {
    return network_.flow().inflow;
  }  ///< m3/s, of the network before the vessel ruptures
  const std::vector<double>& leaks() const { return network_.flow().leaks; }
  std::optional<double> flop() const { return network_.flow().flop; }
  /// The vessel's opening as seen from the network, area in m2.
  hemodynamics::Orifice orifice(double opening) const;

  bool two_way() const { return c_.coupling.mode == "two_way"; }
  /// Writes the network's files.
  void write(const output::ResultsFolder& folder);
  /// The same, and begins coupling.csv where coupling is two-way, or continues it after `restore`.
  void open(const output::ResultsFolder& folder);

  /// What a restart needs beside the input, from which the network is solved anew: the exchange so far, and
  /// what the network was like, to be compared. Collective.
  void save(output::CheckpointWriter& file) const;
  /// Goes on from there at `time_s`; reads what there is of coupling.csv in `directory`. Throws InputError
  /// where the network is not as it was. Collective.
  void restore(output::CheckpointReader& file, double time_s, const std::filesystem::path& directory);

  /// Largest net pressure on the simulated wall by the last exchange, Pa; `profile` is relative to it.
  double pressure() const { return coupling::largest_load(load_, data_, piece_); }
  /// The same before the vessel ruptures: by the network's first solution.
  double intact_pressure() const { return coupling::largest_load(first_load_, data_, piece_); }
  std::vector<double> profile(std::int64_t rows, double row_spacing) const;

  /// Whether a window ends at this step.
  bool due(long step) const { return two_way() && step % steps_per_window_ == 0; }
  /// What the wall is like at the end of a window.
  struct Wall {
    double time_s = 0;
    double schedule = 0;           ///< share of the network's pressures that acts now
    double opening = 0;            ///< m2
    double resistance_factor = 1;  ///< of the deformed lumen
  };
  /// Solves the network anew around the vessel. Collective.
  void exchange(const Wall& wall);
  /// Counts what leaks until then.
  void end(double time_s);
  double leak() const { return leak_; }  ///< m3/s, by the last exchange
  /// Number, of the flow at the vessel's ends, by all exchanges; its viscosity with the haematocrit of all
  /// blood.
  double highest_reynolds() const { return highest_reynolds_; }

  /// The cascade that this vessel is the next event of: for the pictures, and saved with the vessel.
  void set_cascade(const CascadeState* cascade) { cascade_ = cascade; }
  /// The network as it is shown: with the vessel's place, pressure and leak.
  LineSource& lines();
  nlohmann::ordered_json network_record() const;
  nlohmann::ordered_json results() const;
  void print_header(runtime::Console& console) const;
  void print_summary(runtime::Console& console) const;

 private:
  static constexpr const char* table_name = "coupling.csv";
  static constexpr const char* table_header =
      "time_s,schedule,net_pressure_from_Pa,net_pressure_middle_Pa,net_pressure_to_Pa,opening_m2,leak_m3_s,"
      "inflow_m3_s,outflow_m3_s,resistance_factor,imbalance";

  void find_named_vessel();
  void choose();
  void compare_with(output::CheckpointReader& file) const;
  template <class Coupling, class Visit>
  static void for_each_number(Coupling& coupling, const Visit& visit);
  void find_load(const std::array<double, 3>& heart);
  void choose_places();
  void warn_of_a_short_piece();
  double middle_outside() const { return parts_[1].outside(); }

  Configuration c_;  ///< with the vessel's geometry
  parallel::Communicator comm_;
  std::unique_ptr<hemodynamics::FlowSolver> solver_;
  studies::SolvedNetwork network_;
  std::optional<std::int64_t> named_;  ///< number of coupling.vessel, where it is named
  hemodynamics::NetworkVessel chosen_;
  bool at_rest_ = false;
  double risk_ = 0;
  std::unique_ptr<hemodynamics::VesselInNetwork> vessel_;
  coupling::VesselData data_;
  coupling::WallSegment piece_;
  /// At the vessel's beginning, middle and end; the heart's by the last exchange.
  std::array<coupling::PressureParts, 3> parts_{};
  coupling::AxialLoad load_, first_load_;
  const CascadeState* cascade_ = nullptr;
  long steps_per_window_ = 1;
  std::int64_t windows_ = 0;
  double leak_ = 0, leaked_ = 0, last_time_ = 0;  ///< m3/s, m3, s
  double worst_imbalance_ = 0, schedule_ = 1, highest_reynolds_ = 0;
  double network_s_ = 0, exchange_s_ = 0;
  std::string kept_table_;  ///< what a restart keeps of coupling.csv; of the first rank
  output::TableFile table_;
};

}  // namespace rhexis::app
