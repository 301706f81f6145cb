// SPDX-License-Identifier: BSD-3-Clause
/// The four kinds of scene: each declares its keys, and resolves what follows from their values.
#pragma once

#include <string>

#include "parallel/communicator.hpp"
#include "scenes/configuration.hpp"

namespace rhexis::scenes {

/// The keys of a vessel's wall, its load and its output, which scenes of one vessel, of a coupled one and of
/// an ensemble share.
ParameterList declare_wall(Configuration& c);
/// Makes c.wall of c.vessel, with warnings, and plans the outputs. Throws InputError. Collective.
void make_wall(Configuration& c, parallel::Communicator comm);
/// Where results are told by pressure, it should be one that walls have seen.
void warn_of_an_unfinished_ramp(Configuration& c);

ParameterList declare_vessel_scene(Configuration& c);
void resolve_vessel_scene(Configuration& c, parallel::Communicator comm);

/// The keys of a network, its blood and its screening, which a coupled scene shares.
ParameterList declare_network(Configuration& c);
/// Checks them and makes the rules of a tree.
void resolve_network(Configuration& c, parallel::Communicator comm);

ParameterList declare_network_scene(Configuration& c);

ParameterList declare_coupled_scene(Configuration& c);
/// What can be told before the network is solved; the wall is made later, by resolve_coupled_wall.
void resolve_coupled_scene(Configuration& c, parallel::Communicator comm);
/// Keys of a vessel that its network takes over where they are coupled.
bool network_sets(const std::string& key);
/// Keys of a network that its vessel takes over where they are coupled.
bool vessel_sets(const std::string& key);

ParameterList declare_ensemble_scene(Configuration& c);
void resolve_ensemble_scene(Configuration& c, parallel::Communicator comm);

}  // namespace rhexis::scenes
