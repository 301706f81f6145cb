// SPDX-License-Identifier: BSD-3-Clause
/// `rhexis check`: what an input file amounts to, before anybody pays for it.
#pragma once

#include "app/configuration.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::app {

/// Prints the derived numbers of a valid scene: spacing, horizon, particles, bonds, time step, memory, and
/// the time a run will take, from a few steps timed here and now; of a network, vessels, the first and a last
/// one, memory and time. Throws InputError for what only now is seen to be wrong. Collective.
void check(const scenes::VesselScene& s, const scenes::Reading& reading);
void check(const scenes::NetworkScene& s, const scenes::Reading& reading);
void check(const scenes::CoupledScene& s, const scenes::Reading& reading);
void check(const scenes::EnsembleScene& s, const scenes::Reading& reading);

}  // namespace rhexis::app
