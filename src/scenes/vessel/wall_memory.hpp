// SPDX-License-Identifier: BSD-3-Clause
/// Whether a wall fits into memory, before any of it is made.
#pragma once

#include "scenes/configuration.hpp"

namespace rhexis::scenes {

/// Has `c.say` tell what the wall of `resolved` parameters takes. Throws InputError, of the key that is most
/// likely at fault, where the memory of this machine does not suffice; the message says what would fit.
/// Collective.
void check_memory(const Configuration& c, const peridynamics::Parameters& resolved,
                  parallel::Communicator comm);

}  // namespace rhexis::scenes
