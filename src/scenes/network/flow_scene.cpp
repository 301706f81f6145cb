// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/network/flow_scene.hpp"

#include "core/error.hpp"
#include "input/units.hpp"
#include "output/parameters.hpp"
#include "runtime/version.hpp"

namespace rhexis::scenes {

hemodynamics::FlowProblem flow_problem(const Configuration& c, const studies::CascadeState* cascade) {
  return {.network = c.network,
          .tree = c.tree,
          .blood = c.hemodynamics,
          .to_si = input::to_si,
          .failures = cascade != nullptr ? cascade->failures : std::vector<hemodynamics::VesselFailure>{}};
}

screening::Criterion screening_criterion(const Configuration& c) {
  screening::Criterion criterion{c.screening.critical_stretch, c.network.wall.young_modulus,
                                 c.network.wall.poisson_ratio, 0};
  if (c.is_coupled()) criterion.outside_pressure = coupling::outside_everywhere(c.coupling);
  return criterion;
}

studies::ScreeningPlan screening_plan(const Configuration& c, const studies::CascadeState* cascade) {
  return {screening_criterion(c), static_cast<std::size_t>(c.screening.top),
          cascade != nullptr ? cascade->simulated : std::vector<std::uint32_t>{}};
}

studies::NetworkFilesPlan network_files_plan(const Configuration& c) {
  return {c.title, runtime::version(), output::formats_of(c.output), c.network.vtp};
}

std::unique_ptr<hemodynamics::FlowSolver> prepared_solver(const Configuration& c, parallel::Communicator comm,
                                                          const studies::CascadeState* cascade) {
  try {
    return hemodynamics::prepared_solver(flow_problem(c, cascade), comm);
  } catch (const InputError& error) {
    throw input::located(error, c.resolved);
  }
}

std::unique_ptr<hemodynamics::FlowSolver> checked_solver(const Configuration& c,
                                                         parallel::Communicator comm) {
  try {
    return hemodynamics::checked_solver(flow_problem(c), comm);
  } catch (const InputError& error) {
    throw input::located(error, c.resolved);
  }
}

}  // namespace rhexis::scenes
