/// Coupled scenes: one vessel of a network, or a cascade of them.
#pragma once

#include "app/configuration.hpp"
#include "app/run_options.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::app {

/// From the configuration to its results. Collective. Throws as VesselRun::run.
Ending run_coupled(Configuration configuration, const RunOptions& options, parallel::Communicator comm);

}  // namespace rhexis::app
