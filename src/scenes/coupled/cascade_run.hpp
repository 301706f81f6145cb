// SPDX-License-Identifier: BSD-3-Clause
/// Ruptures one after the other.
#pragma once

#include "scenes/coupled/coupled_scene.hpp"

namespace rhexis::scenes {

/// Each event has a folder of its own, with all that a coupled run leaves; what the cascade adds is
/// cascade.csv and run.json beside them, and after each event a checkpoint. Throws as VesselRun::run.
/// Collective.
runtime::Ending run_cascade(CoupledScene scene, const runtime::RunOptions& options,
                            parallel::Communicator comm);

}  // namespace rhexis::scenes
