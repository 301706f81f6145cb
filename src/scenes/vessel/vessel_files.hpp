// SPDX-License-Identifier: BSD-3-Clause
/// What the run of a vessel writes to its folder, known from its input.
#pragma once

#include <string>
#include <vector>

#include "scenes/vessel/vessel_scene.hpp"

namespace rhexis::scenes {

/// What the whole run does to its folder, but for the files of a restart whose names depend on its first step
/// (see files_of_steps).
output::FolderPlan folder_plan(const VesselScene& s, const runtime::RunOptions& options);

/// The names of what every run of a vessel writes, whatever its first step is.
std::vector<std::string> vessel_file_names();
/// The film of a run that draws; none of another.
std::vector<std::string> movie_names(const output::Parameters& output, const runtime::PicturesPlan& pictures);

/// The series of particles of a run from `first_step`, without an ending: a restart leaves the series of the
/// run that it continues as it is.
std::string series_name(long first_step, bool restarts);
/// Relative to the folder of the results.
std::string checkpoint_name(long step);

/// That series and the checkpoints that may follow until `last_step`, also those which an interrupt asks for.
output::FutureFiles files_of_steps(const output::Parameters& output, long first_step, long last_step,
                                   bool restarts);

}  // namespace rhexis::scenes
