// SPDX-License-Identifier: BSD-3-Clause
/// The input that checkpoints hold, and a restart's compared with it.
#pragma once

#include <string>

#include "output/checkpoint.hpp"
#include "peridynamics/parameters.hpp"
#include "scenes/scene.hpp"

namespace rhexis::scenes {

/// The name by which a checkpoint holds the step of a vessel's run: by it those of cascades between events
/// are told from those of vessels.
inline constexpr const char* step_name = "step";

/// `wall`: null, or the resolved parameters of the wall, whose geometry a network may have given. Collective.
void write_input(output::CheckpointWriter& file, const SceneInput& s, const peridynamics::Parameters* wall);

/// Refuses the checkpoint of another body; warns of what else is different from `since` on. `wall` as for
/// `write_input`. Collective; throws InputError.
void compare_input(output::CheckpointReader& file, SceneInput& s, const peridynamics::Parameters* wall,
                   const std::string& since);

}  // namespace rhexis::scenes
