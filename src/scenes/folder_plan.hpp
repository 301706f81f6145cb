// SPDX-License-Identifier: BSD-3-Clause
/// What a run reads and what it writes to its folder, known from its configuration.
#pragma once

#include "output/results_folder.hpp"
#include "runtime/run_options.hpp"
#include "scenes/configuration.hpp"

namespace rhexis::scenes {

/// What the whole run does to its folder, but for what depends on a checkpoint: the checkpoints of a
/// cascade's events, and the files of a restart whose names depend on its first step (see files_of_steps).
output::FolderPlan folder_plan(const Configuration& c, const runtime::RunOptions& options);

/// The series of particles of a run from `first_step`, without an ending: a restart leaves the series of the
/// run that it continues as it is.
std::string series_name(long first_step, bool restarts);
/// Relative to the folder of the results.
std::string checkpoint_name(long step);

/// The folder of a cascade's event, from 1 on, and the checkpoint between that event and the next; relative
/// to the cascade's folder.
std::string event_name(std::size_t event);
std::string event_checkpoint_name(std::size_t event);
/// The event whose folder a file of a cascade is in; 0 where it is in none.
std::size_t event_number(const std::string& name);

/// That series and the checkpoints that may follow, also those which an interrupt asks for.
output::FutureFiles files_of_steps(const Configuration& c, long first_step, bool restarts);

}  // namespace rhexis::scenes
