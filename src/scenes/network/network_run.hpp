// SPDX-License-Identifier: BSD-3-Clause
/// The flow in a network from its scene to its results.
#pragma once

#include "scenes/network/network_scene.hpp"

namespace rhexis::scenes {

/// Throws RunError (after noting it in run.json) or InputError (nothing written). Collective.
runtime::Ending run(NetworkScene scene, const runtime::RunOptions& options, parallel::Communicator comm);

}  // namespace rhexis::scenes
