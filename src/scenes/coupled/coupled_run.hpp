// SPDX-License-Identifier: BSD-3-Clause
/// Coupled scenes: one vessel of a network, or a cascade of them.
#pragma once

#include "scenes/coupled/coupled_scene.hpp"

namespace rhexis::scenes {

/// From the scene to its results. Throws as VesselRun::run. Collective.
runtime::Ending run(CoupledScene scene, const runtime::RunOptions& options, parallel::Communicator comm);

}  // namespace rhexis::scenes
