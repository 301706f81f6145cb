// SPDX-License-Identifier: BSD-3-Clause
/// Coupled scenes: one vessel of a network, or a cascade of them.
#pragma once

#include "parallel/communicator.hpp"
#include "runtime/run_options.hpp"
#include "scenes/configuration.hpp"

namespace rhexis::scenes {

/// From the configuration to its results. Collective. Throws as VesselRun::run.
runtime::Ending run_coupled(Configuration configuration, const runtime::RunOptions& options,
                            parallel::Communicator comm);

}  // namespace rhexis::scenes
