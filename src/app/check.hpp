// SPDX-License-Identifier: BSD-3-Clause
/// `rhexis check`: what an input file amounts to, before anybody pays for it.
#pragma once

#include "app/configuration.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::app {

/// Prints the derived numbers of a valid configuration: spacing, horizon, particles, bonds, time step,
/// memory, and the time a run will take, from a few steps timed here and now.
void check(const Configuration& c, parallel::Communicator comm);

/// The same of a network: vessels, the first and a last one, memory, time. Throws InputError for a file that
/// is wrong.
void check_network(const Configuration& c, parallel::Communicator comm);

}  // namespace rhexis::app
