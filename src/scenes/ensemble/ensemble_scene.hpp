// SPDX-License-Identifier: BSD-3-Clause
/// How probably a vessel ruptures, from many walls whose properties scatter.
#pragma once

#include "scenes/vessel/wall_input.hpp"
#include "studies/ensemble/parameters.hpp"

namespace rhexis::scenes {

struct EnsembleScene : SceneInput {
  static constexpr const char* model = "ensemble";

  ensemble::Parameters ensemble;
  peridynamics::Parameters vessel;  ///< the mean one, as read

  peridynamics::SharedWall wall;  ///< wall of the mean vessel
};

ParameterList declare(EnsembleScene& s);

/// Throws InputError. Collective.
void resolve(EnsembleScene& s, const Reading& reading);

output::FolderPlan folder_plan(const EnsembleScene& s, const runtime::RunOptions& options);

}  // namespace rhexis::scenes
