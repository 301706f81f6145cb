// SPDX-License-Identifier: BSD-3-Clause
/// The network of a scene, from its configuration.
#pragma once

#include <memory>

#include "scenes/configuration.hpp"
#include "studies/cascade/cascade_state.hpp"
#include "studies/flow/network_files.hpp"
#include "studies/flow/solved_network.hpp"

namespace rhexis::scenes {

/// `cascade`: null, or what the events so far left of the network.
hemodynamics::FlowProblem flow_problem(const Configuration& c,
                                       const studies::CascadeState* cascade = nullptr);
screening::Criterion screening_criterion(const Configuration& c);
studies::ScreeningPlan screening_plan(const Configuration& c, const studies::CascadeState* cascade = nullptr);
studies::NetworkFilesPlan network_files_plan(const Configuration& c);

/// hemodynamics::prepared_solver and checked_solver; InputErrors are complete with place.
std::unique_ptr<hemodynamics::FlowSolver> prepared_solver(const Configuration& c, parallel::Communicator comm,
                                                          const studies::CascadeState* cascade = nullptr);
std::unique_ptr<hemodynamics::FlowSolver> checked_solver(const Configuration& c, parallel::Communicator comm);

}  // namespace rhexis::scenes
