// SPDX-License-Identifier: BSD-3-Clause
/// The state of a cascade between two of its events, as it goes on from it and as it is stored.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hemodynamics/steady/flow_solver.hpp"
#include "hemodynamics/steady/ruptured_network.hpp"
#include "output/checkpoint.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::studies {

/// One vessel that was simulated. What followed is known once the network has been solved with what it left.
struct CascadeEvent {
  hemodynamics::NetworkVessel vessel;
  double risk = 0;          ///< risk of that vessel (studies/screening/screening.hpp)
  double net_pressure = 0;  ///< Pa, the largest on the intact wall
  /// Whether the wall ruptured; none where an interrupt ended the event before it did.
  std::optional<bool> ruptured = {};
  std::optional<double> time = {}, rupture_onset = {};  ///< s, of the onset, in the cascade and in the event
  double opening = 0;                                   ///< m2, at the event's end
  double inflow_before = 0;                             ///< m3/s, of the network
  std::optional<double> inflow_after = {}, leak = {};   ///< m3/s
  std::optional<std::string> next_vessel = {};
  std::optional<double> next_risk = {};
};

struct CascadeState {
  std::vector<CascadeEvent> events;
  std::vector<hemodynamics::VesselFailure>
      failures;                          ///< the vessels that ruptured, in the order in which they did
  std::vector<std::uint32_t> simulated;  ///< numbers of the vessels, whether they ruptured or held
  double elapsed = 0;                    ///< s, simulated in all events
  std::int64_t steps_before = 0;         ///< time steps of all earlier events, for the numbers of pictures

  /// Takes up an event that simulated `seconds` in `steps`, and what it left of the network, where its vessel
  /// ruptured.
  void record(CascadeEvent event, const std::optional<hemodynamics::VesselFailure>& failure, double seconds,
              std::int64_t steps);
};

/// Event `number`, from 1 on, as run.json has it.
nlohmann::ordered_json to_json(const CascadeEvent& event, std::size_t number);

/// cascade.csv: a row for each event.
std::string cascade_table(const std::vector<CascadeEvent>& events);

/// The name by which a checkpoint holds the number of events, and so tells that it is of a cascade.
inline constexpr const char* cascade_name = "cascade_events";

/// The root's state. Collective.
void save_cascade(const CascadeState& state, parallel::Communicator comm, output::CheckpointWriter& file);
/// The same on every rank. Collective; throws InputError that names the file.
CascadeState read_cascade(output::CheckpointReader& file);

}  // namespace rhexis::studies
