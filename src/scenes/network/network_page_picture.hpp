// SPDX-License-Identifier: BSD-3-Clause
/// The picture of `rhexis network`: vessels in the colours of their radii, and the ends, with or without a
/// condition.
#pragma once

#include <filesystem>

#include "network/graph.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::scenes {

/// Throws InputError where ParaView is missing or finds no way to draw. Collective.
void check_picture_can_be_drawn(parallel::Communicator comm);

/// Draws the network that the root rank has to the file `path` (PNG), in place of what has that name; of very
/// many vessels the widest. Throws RunError. Collective; can be called once in a process.
void draw_network_page(const network::BoundedGraph& network, const std::filesystem::path& path,
                       parallel::Communicator comm);

}  // namespace rhexis::scenes
