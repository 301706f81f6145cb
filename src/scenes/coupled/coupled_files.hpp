// SPDX-License-Identifier: BSD-3-Clause
/// What the run of a coupled scene writes to its folder, known from its input.
#pragma once

#include <cstddef>
#include <string>

#include "scenes/coupled/coupled_scene.hpp"

namespace rhexis::scenes {

/// What the whole run does to its folder, but for what depends on a checkpoint: the checkpoints of a
/// cascade's events, and the files of a restart whose names depend on its first step (see files_of_steps).
output::FolderPlan folder_plan(const CoupledScene& s, const runtime::RunOptions& options);

/// The table of a cascade's events.
inline constexpr const char* cascade_table_name = "cascade.csv";
/// The folder of a cascade's event, from 1 on, and the checkpoint between that event and the next; relative
/// to the cascade's folder.
std::string event_name(std::size_t event);
std::string event_checkpoint_name(std::size_t event);
/// The event whose folder a file of a cascade is in; 0 where it is in none.
std::size_t event_number(const std::string& name);

}  // namespace rhexis::scenes
