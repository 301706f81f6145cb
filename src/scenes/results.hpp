// SPDX-License-Identifier: BSD-3-Clause
/// What came out of a run: the `results` part of run.json.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "studies/flow/network_record.hpp"

namespace rhexis::scenes {

/// The `results` part; a member without a value is written as null.
struct Results {
  std::optional<std::int64_t> particles = {};
  std::optional<std::int64_t> bonds = {};  ///< undirected
  std::optional<std::int64_t> family_max = {};
  std::optional<double> time_step_s = {}, stable_time_step_s = {};
  std::optional<std::int64_t> steps = {};
  std::optional<double> simulated_s = {};
  std::optional<double> first_bond_break_s = {};
  std::optional<double> rupture_onset_s = {};       ///< first time that some particle's damage >= 0.2
  std::optional<double> pressure_at_onset_Pa = {};  ///< the largest in the vessel, as load.direction means it
  /// The blood pressure that pushes the stretched lumen as hard: the one above, of a dead load over the
  /// lumen's stretch.
  std::optional<double> blood_pressure_at_onset_Pa = {};
  std::optional<double> max_displacement_at_onset_m = {};
  std::optional<double> max_displacement_m = {}, max_damage = {};
  std::optional<double> rupture_length_m = {};  ///< axial extent of damage >= 0.2
  std::optional<double> opening_area_m2 = {};   ///< area of the holes in the wall, at the end
  std::optional<double> energy_drift = {};
  nlohmann::ordered_json network = studies::network_record();
  nlohmann::ordered_json coupling = nullptr;  ///< the vessel's place in the network, and what they exchanged
  nlohmann::ordered_json cascade = nullptr;   ///< its events
  nlohmann::ordered_json ensemble = nullptr;  ///< pressures, samples and their cost
};

void to_json(nlohmann::ordered_json& json, const Results& results);

}  // namespace rhexis::scenes
