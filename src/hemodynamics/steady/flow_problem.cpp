// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/flow_problem.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/format.hpp"

namespace rhexis::hemodynamics {

std::string describe_source(const FlowProblem& problem) {
  if (!problem.is_tree()) return fmt::format("{}", fmt::join(problem.network.files, ", "));
  const int generations = problem.tree.generations;
  return fmt::format("tree pair of {} generations, {} vessels in memory", generations,
                     grouped(static_cast<long long>(network::TreePair::vessels_of(generations))));
}

TreeBoundary driving_boundary(const FlowProblem& problem, const network::TreePair& tree,
                              const Hydrostatic& hydrostatic) {
  const auto weight = [&](const network::Point& p) { return hydrostatic.pressure(p[0], p[1], p[2]); };
  TreeBoundary boundary = tree_boundary(problem.blood);
  if (boundary.inlet_pressure) *boundary.inlet_pressure -= weight(tree.inlet());
  if (boundary.outlet_pressure)
    *boundary.outlet_pressure -= weight(network::TreePair::mirrored(tree.inlet()));
  return boundary;
}

VesselMechanics mechanics_of(const FlowProblem& problem) {
  const network::WallParameters& w = problem.network.wall;
  VesselMechanics m{.artery_wall = w.artery,
                    .vein_wall = w.vein,
                    .variation = network::WallVariation(problem.network.weakness),
                    .numbered_by_id = problem.is_tree(),
                    .young_modulus = w.young_modulus,
                    .poisson_ratio = w.poisson_ratio,
                    .viscosity = problem.blood.viscosity,
                    .hydrostatic = {problem.blood.density, {}}};
  std::copy(problem.blood.acceleration.begin(), problem.blood.acceleration.end(),
            m.hydrostatic.acceleration.begin());
  if (problem.is_tree()) m.variation.mark_in_tree(problem.network.weakness, problem.tree.generations);
  return m;
}

std::size_t most_shown(const FlowProblem& problem) {
  const std::int64_t usual = problem.is_tree() ? 20000 : 5000000;
  return static_cast<std::size_t>(problem.network.shown_vessels.value_or(usual));
}

}  // namespace rhexis::hemodynamics
