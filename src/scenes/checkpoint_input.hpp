// SPDX-License-Identifier: BSD-3-Clause
/// The input that checkpoints hold, and a restart's compared with it.
#pragma once

#include <string>

#include "output/checkpoint.hpp"
#include "scenes/configuration.hpp"

namespace rhexis::scenes {

/// The name by which a checkpoint holds the step of a vessel's run: by it those of cascades between events
/// are told from those of vessels.
inline constexpr const char* step_name = "step";

/// Collective.
void write_input(output::CheckpointWriter& file, const Configuration& c);

/// Refuses the checkpoint of another body; warns of what else is different from `since` on. Collective;
/// throws InputError.
void compare_input(output::CheckpointReader& file, Configuration& c, const std::string& since);

}  // namespace rhexis::scenes
