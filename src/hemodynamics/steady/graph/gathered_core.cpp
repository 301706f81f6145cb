// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/gathered_core.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "hemodynamics/steady/graph/boundary.hpp"
#include "parallel/exchange.hpp"

namespace rhexis::hemodynamics {
namespace {

/// Junctions of all ranks, once each, by ascending id.
std::vector<CorePart::Junction> merged(std::vector<CorePart::Junction> junctions) {
  std::stable_sort(junctions.begin(), junctions.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  std::vector<CorePart::Junction> result;
  for (const auto& junction : junctions) {
    if (result.empty() || result.back().id != junction.id) {
      result.push_back(junction);
    } else if (!junction.fixed) {
      result.back().value += junction.value;
    }
  }
  return result;
}

}  // namespace

CorePartSolution solve_gathered(const CorePart& part, const GraphSolverOptions& options,
                                parallel::Communicator comm) {
  const auto vessels = parallel::all_gather(comm, part.vessels);
  const auto junctions = merged(parallel::all_gather(comm, part.junctions).records);
  const auto index_of = [&](std::int64_t id) {
    const auto at =
        std::lower_bound(junctions.begin(), junctions.end(), id,
                         [](const auto& junction, std::int64_t wanted) { return junction.id < wanted; });
    return static_cast<std::uint32_t>(at - junctions.begin());
  };
  network::Graph graph;
  graph.junctions = junctions.size();
  std::vector<double> conductance;
  for (const auto& [tail, head, g] : vessels.records) {
    graph.from.push_back(index_of(tail));
    graph.to.push_back(index_of(head));
    conductance.push_back(g);
  }
  const std::vector<bool> connected = junctions_with_vessels(graph);
  std::vector<network::BoundaryCondition> conditions;
  for (std::uint32_t j = 0; j < junctions.size(); ++j) {
    const auto& [id, value, fixed] = junctions[j];
    graph.junction_name.push_back(std::to_string(id));
    if (fixed) {
      conditions.push_back({j, network::BoundaryCondition::Kind::pressure, value, 0});
    } else if (!connected[j]) {
      throw_floating(std::to_string(id));
    } else if (value != 0) {
      conditions.push_back({j, network::BoundaryCondition::Kind::flow, value, 0});
    }
  }
  const GraphFlow solved = solve_flow(graph, std::move(conductance), conditions, options);
  const auto first = solved.flow.begin() + vessels.start[static_cast<std::size_t>(comm.rank())];
  CorePartSolution result{{first, first + static_cast<std::ptrdiff_t>(part.vessels.size())},
                          {},
                          solved.solver,
                          solved.iterations,
                          solved.core_junctions};
  for (const auto& junction : part.junctions)
    result.pressure.push_back(solved.pressure[index_of(junction.id)]);
  return result;
}

}  // namespace rhexis::hemodynamics
