// SPDX-License-Identifier: BSD-3-Clause
/// Whether a wall fits into memory, before any of it is made.
#pragma once

#include "app/configuration.hpp"

namespace rhexis::app {

/// Finds c.wall_size and c.wall_memory of resolved parameters, and has `c.say` tell of them. Throws
/// InputError, of the key that is most likely at fault, where the memory of this machine does not suffice;
/// the message says what would fit. Collective.
void settle_memory(Configuration& c, parallel::Communicator comm);

}  // namespace rhexis::app
