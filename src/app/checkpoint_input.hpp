/// The input that checkpoints hold, and a restart's compared with it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "app/configuration.hpp"
#include "output/checkpoint.hpp"

namespace rhexis::app {

/// The names by which a checkpoint holds the step of a vessel's run and the vessel's name in its network: by
/// them checkpoints of cascades between events, of vessels alone and of coupled ones are told apart.
inline constexpr const char* step_name = "step";
inline constexpr const char* coupled_vessel_name = "coupled_vessel";

/// Whether two solutions of one network agree: on another kind of processor their last digits may differ.
inline bool alike(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

/// Collective.
void write_input(output::CheckpointWriter& file, const Configuration& c);

/// Refuses the checkpoint of another body; warns of what else is different from `since` on. Collective;
/// throws InputError.
void compare_input(output::CheckpointReader& file, Configuration& c, const std::string& since);

}  // namespace rhexis::app
