// SPDX-License-Identifier: BSD-3-Clause
/// What a network's run says of itself at the terminal.
#pragma once

#include <string>
#include <vector>

#include "hemodynamics/steady/flow_solver.hpp"
#include "runtime/console.hpp"
#include "studies/flow/solved_network.hpp"

namespace rhexis::scenes {

/// The network with its survey, before anything is solved.
void print_source(runtime::Console& console, const hemodynamics::FlowSolver& solver);
/// What the survey of the network warns of; nothing of a tree.
std::vector<std::string> warnings_of(const hemodynamics::FlowSolver& solver);

/// Network and blood, before the flow is solved.
void print_network(runtime::Console& console, const hemodynamics::FlowSolver& solver,
                   const hemodynamics::Parameters& blood);

/// The solution: a table of the generations where there are some, totals, vessels that were asked for, and
/// those at risk.
void print_solution(runtime::Console& console, const studies::SolvedNetwork& network);

}  // namespace rhexis::scenes
