// SPDX-License-Identifier: BSD-3-Clause
/// A network in an input: its keys, which scenes of a network and of a coupled vessel share, and what follows
/// from them.
#pragma once

#include <cstdint>
#include <vector>

#include "hemodynamics/steady/flow_problem.hpp"
#include "input/units.hpp"
#include "scenes/scene.hpp"
#include "studies/flow/network_files.hpp"
#include "studies/screening/parameters.hpp"

namespace rhexis::scenes {

struct NetworkInput {
  hemodynamics::FlowProblem problem{.to_si = input::to_si};
  screening::Parameters screening;
};

/// The keys of a network, its blood and its screening.
ParameterList declare_network(NetworkInput& n);

/// Checks them and makes the rules of a tree. Throws InputError. Collective.
void resolve_network(SceneInput& s, NetworkInput& n, parallel::Communicator comm);

/// How the vessels are screened. `outside_pressure`: Pa, on all of them; `left_out`: numbers of a graph's
/// vessels that are not screened.
studies::ScreeningPlan screening_plan(const NetworkInput& n, double outside_pressure = 0,
                                      std::vector<std::uint32_t> left_out = {});

studies::NetworkFilesPlan network_files_plan(const SceneInput& s, const NetworkInput& n,
                                             const output::Parameters& output);

}  // namespace rhexis::scenes
