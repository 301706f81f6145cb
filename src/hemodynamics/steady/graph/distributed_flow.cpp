// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/distributed_flow.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "hemodynamics/steady/graph/gathered_core.hpp"
#include "hemodynamics/steady/graph/junction_directory.hpp"
#include "hemodynamics/steady/graph/reducible.hpp"
#include "hemodynamics/steady/graph/shared_core.hpp"
#include "parallel/together.hpp"

namespace rhexis::hemodynamics {
namespace {

constexpr std::uint32_t none = Reduction::none;

/// What reduction has left on this rank.
struct Left {
  std::vector<std::uint32_t> vessel, junction;  // of the reduction: ghosts have numbers too
  CorePart part;
  std::vector<parallel::SharedLink> links;  // in indices of `junction`
};

Left what_is_left(const DistributedGraph& graph, const JunctionDirectory& directory,
                  const Reduction& reduction) {
  const auto& links = directory.links;
  const Boundary& boundary = directory.boundary;
  Left left{reduction.vessels_left(), {}, {}, links};
  std::vector<std::uint32_t> number(graph.local.junctions + boundary.ghosts.size(), none);
  const auto id_of = [&](std::uint32_t j) {
    const std::size_t junctions = graph.local.junctions;
    // A junction has one ghost at most.
    return j < junctions ? graph.junction_id[j]
                         : -1 - graph.junction_id[boundary.ghosts[j - junctions].junction];
  };
  const auto add = [&](std::uint32_t j, double value, bool fixed) {
    if (number[j] != none) return;
    number[j] = static_cast<std::uint32_t>(left.junction.size());
    left.junction.push_back(j);
    left.part.junctions.push_back({id_of(j), value, fixed});
  };
  for (const auto& [j, pressure] : all_fixed(graph.local, boundary)) add(j, pressure, true);
  for (const auto& link : links) {
    for (const auto* side : {&link.owned, &link.borrowed}) {
      for (const std::uint32_t j : *side) {
        if (directory.connected[j]) add(j, reduction.injection(j), false);
      }
    }
  }
  for (const std::uint32_t v : left.vessel) {
    const std::uint32_t tail = reduction.tail(v), head = reduction.head(v);
    for (const std::uint32_t j : {tail, head}) add(j, reduction.injection(j), false);
    left.part.vessels.push_back({id_of(tail), id_of(head), reduction.conductance(v)});
  }
  for (auto& link : left.links) {
    for (auto* side : {&link.owned, &link.borrowed}) {
      for (std::uint32_t& j : *side) j = number[j];
      std::erase(*side, none);  // no vessels on any rank
    }
  }
  return left;
}

bool is_gathered(const Left& left, const GraphSolverOptions& options, parallel::Communicator comm) {
  const std::int64_t vessels =
      comm.all_reduce(static_cast<std::int64_t>(left.vessel.size()), parallel::Reduce::sum);
  if (options.solver == GraphSolver::automatic) return vessels <= largest_to_gather;
  return options.solver != GraphSolver::amg;
}

}  // namespace

GraphFlow solve_flow(const DistributedGraph& graph, std::vector<double> conductance,
                     std::span<const network::BoundaryCondition> conditions,
                     const GraphSolverOptions& options, parallel::Communicator comm) {
  parallel::together(comm, [&] { check_vessels(graph.local, conductance); });
  const JunctionDirectory directory = look_up(graph.local, graph.junction_id, conditions, comm);
  std::vector<std::uint32_t> shared_junctions;
  for (const auto& link : directory.links) {
    for (const auto* side : {&link.owned, &link.borrowed}) {
      shared_junctions.insert(shared_junctions.end(), side->begin(), side->end());
    }
  }
  Reduction reduction = reducible(graph.local, std::move(conductance), directory.boundary, shared_junctions);
  reduction.reduce();
  parallel::together(comm, [&] {
    const std::uint32_t floating = reduction.floating_junction();
    if (floating != Reduction::none) throw_floating(std::to_string(graph.junction_id[floating]));
  });
  GraphFlow result;
  {
    const Left left = what_is_left(graph, directory, reduction);
    const CorePartSolution core =
        is_gathered(left, options, comm)
            ? solve_gathered(left.part, options, comm)
            : solve_shared(left.part, left.links, sum_of_inflows(directory.boundary), options, comm);
    for (std::size_t n = 0; n < left.junction.size(); ++n)
      reduction.set_pressure(left.junction[n], core.pressure[n]);
    for (std::size_t n = 0; n < left.vessel.size(); ++n) reduction.set_flow(left.vessel[n], core.flow[n]);
    result.solver = core.solver;
    result.iterations = core.iterations;
    result.core_junctions = core.core_junctions;
  }
  reduction.restore();
  result.pressure = reduction.take_pressure();
  result.flow = reduction.take_flow();
  parallel::SharedValues shared(comm, directory.links);
  judge(graph.local, directory.boundary, 0, &shared, result);
  set_pressures_of_conditions(directory.boundary, directory.connected, result.pressure);
  shared.copy_from_owner(result.pressure);
  return result;
}

}  // namespace rhexis::hemodynamics
