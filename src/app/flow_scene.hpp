/// The network of a scene, from its configuration.
#pragma once

#include <memory>

#include "app/configuration.hpp"
#include "studies/flow/network_files.hpp"
#include "studies/flow/solved_network.hpp"

namespace rhexis::app {

/// With what the earlier events of a cascade left.
hemodynamics::FlowProblem flow_problem(const Configuration& c);
screening::Criterion screening_criterion(const Configuration& c);
studies::ScreeningPlan screening_plan(const Configuration& c);
studies::NetworkFilesPlan network_files_plan(const Configuration& c);

/// hemodynamics::prepared_solver and checked_solver; InputErrors are complete with place.
std::unique_ptr<hemodynamics::FlowSolver> prepared_solver(const Configuration& c,
                                                          parallel::Communicator comm);
std::unique_ptr<hemodynamics::FlowSolver> checked_solver(const Configuration& c, parallel::Communicator comm);

}  // namespace rhexis::app
