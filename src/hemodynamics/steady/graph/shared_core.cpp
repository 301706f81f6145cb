// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/shared_core.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <unordered_map>

#include "core/error.hpp"
#include "hemodynamics/steady/graph/boomer_amg.hpp"
#include "hemodynamics/steady/graph/boundary.hpp"
#include "hemodynamics/steady/graph/core_solve.hpp"
#include "parallel/exchange.hpp"
#include "parallel/together.hpp"

namespace rhexis::hemodynamics {
namespace {

/// Which sets things belong to that are joined one by one.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<std::size_t> parent_;
};

/// The part's junctions as a CoreSystem wants them: unknown and owned, unknown and borrowed, fixed.
struct Numbering {
  std::vector<std::uint32_t> number;  // of a junction of the part
  std::size_t owned = 0, unknowns = 0;
};

Numbering number_junctions(const CorePart& part, const std::vector<parallel::SharedLink>& links) {
  std::vector<bool> borrowed(part.junctions.size());
  for (const auto& link : links) {
    for (const std::uint32_t j : link.borrowed) borrowed[j] = true;
  }
  Numbering result{std::vector<std::uint32_t>(part.junctions.size())};
  const auto number_those = [&](std::uint32_t next, auto wanted) {
    for (std::size_t j = 0; j < part.junctions.size(); ++j) {
      if (wanted(j)) result.number[j] = next++;
    }
    return next;
  };
  const std::uint32_t owned =
      number_those(0, [&](std::size_t j) { return !part.junctions[j].fixed && !borrowed[j]; });
  const std::uint32_t unknowns =
      number_those(owned, [&](std::size_t j) { return !part.junctions[j].fixed && borrowed[j]; });
  number_those(unknowns, [&](std::size_t j) { return part.junctions[j].fixed; });
  result.owned = owned;
  result.unknowns = unknowns;
  return result;
}

std::vector<CoreVessel> indexed_vessels(const CorePart& part) {
  std::unordered_map<std::int64_t, std::uint32_t> index;
  index.reserve(part.junctions.size());
  for (std::uint32_t j = 0; j < part.junctions.size(); ++j) index[part.junctions[j].id] = j;
  std::vector<CoreVessel> result;
  result.reserve(part.vessels.size());
  for (const auto& [tail, head, g] : part.vessels) result.push_back({index.at(tail), index.at(head), g});
  return result;
}

/// Parts of the network that are joined only through other ranks are followed through the shared junctions.
void check_floating(const CorePart& part, const std::vector<CoreVessel>& vessels,
                    const std::vector<parallel::SharedLink>& links, parallel::Communicator comm) {
  const std::size_t count = part.junctions.size();
  Sets local(count);
  std::vector<bool> held(count);  // by set: has a fixed pressure
  for (const auto& [tail, head, g] : vessels) {
    if (!part.junctions[tail].fixed && !part.junctions[head].fixed) local.join(tail, head);
  }
  for (const auto& [tail, head, g] : vessels) {
    if (part.junctions[tail].fixed) held[local.of(head)] = true;
    if (part.junctions[head].fixed) held[local.of(tail)] = true;
  }
  struct Member {
    std::int64_t id, set;
    bool held;
  };
  std::vector<Member> members;
  std::vector<bool> shared(count);
  const auto report = [&](std::size_t j) {
    if (part.junctions[j].fixed) return;
    const std::size_t set = local.of(j);
    shared[set] = true;
    members.push_back({part.junctions[j].id,
                       (std::int64_t{comm.rank()} << 32) + static_cast<std::int64_t>(set), held[set]});
  };
  for (const auto& link : links) {
    for (const auto* side : {&link.owned, &link.borrowed}) std::for_each(side->begin(), side->end(), report);
  }
  parallel::together(comm, [&] {
    for (std::size_t j = 0; j < count; ++j) {
      const std::size_t set = local.of(j);
      if (!part.junctions[j].fixed && !held[set] && !shared[set])
        throw_floating(std::to_string(part.junctions[j].id));
    }
  });
  // All ranks come to the same conclusion.
  const auto all = parallel::all_gather(comm, members).records;
  std::unordered_map<std::int64_t, std::size_t> of_junction, of_set;
  Sets sets(2 * all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    sets.join(of_junction.try_emplace(all[n].id, 2 * n).first->second,
              of_set.try_emplace(all[n].set, 2 * n + 1).first->second);
  }
  std::vector<bool> set_held(2 * all.size());
  for (const Member& member : all) {
    if (member.held) set_held[sets.of(of_junction[member.id])] = true;
  }
  for (const Member& member : all) {
    if (!set_held[sets.of(of_junction[member.id])]) throw_floating(std::to_string(member.id));
  }
}

/// BoomerAMG on the rows of all ranks.
class SharedAmg final : public Preconditioner {
 public:
  SharedAmg(const CoreSystem& system, parallel::SharedValues& shared, std::int64_t first_row)
      : cycle_(shared.communicator(), first_row, system.owned()) {
    std::vector<double> row(system.junctions());
    for (std::size_t j = 0; j < system.owned(); ++j)
      row[j] = static_cast<double>(first_row) + static_cast<double>(j);
    shared.copy_from_owner(row);
    std::vector<std::int64_t> columns;
    std::vector<double> values;
    for (std::size_t j = 0; j < system.unknowns(); ++j) {
      if (system.neighbours(j).empty()) continue;
      columns.assign(1, static_cast<std::int64_t>(row[j]));
      values.assign(1, system.weight_sum(j));
      for (std::size_t k = 0; k < system.neighbours(j).size(); ++k) {
        const std::uint32_t neighbour = system.neighbours(j)[k];
        if (neighbour >= system.unknowns()) continue;
        columns.push_back(static_cast<std::int64_t>(row[neighbour]));
        values.push_back(-system.weights(j)[k]);
      }
      cycle_.add(columns.front(), columns, values);
    }
    cycle_.finish();
  }
  void apply(std::span<const double> residual, std::span<double> result) override {
    cycle_.apply(residual, result);
  }

 private:
  BoomerAmg cycle_;
};

/// Some fixed pressure, the same on all ranks, to start from.
double some_pressure(const CorePart& part, parallel::Communicator comm) {
  double pressure = -std::numeric_limits<double>::infinity();
  for (const auto& junction : part.junctions) {
    if (junction.fixed) pressure = std::max(pressure, junction.value);
  }
  pressure = comm.all_reduce(pressure, parallel::Reduce::max);
  return std::isfinite(pressure) ? pressure : 0;
}

}  // namespace

CorePartSolution solve_shared(const CorePart& part, const std::vector<parallel::SharedLink>& links,
                              double inflow_by_conditions, const GraphSolverOptions& options,
                              parallel::Communicator comm) {
  std::vector<CoreVessel> vessels = indexed_vessels(part);
  check_floating(part, vessels, links, comm);
  const auto [number, owned, unknowns] = number_junctions(part, links);
  for (CoreVessel& vessel : vessels) vessel = {number[vessel.tail], number[vessel.head], vessel.conductance};
  std::vector<parallel::SharedLink> numbered = links;
  for (auto& link : numbered) {
    for (auto* side : {&link.owned, &link.borrowed}) {
      for (std::uint32_t& j : *side) j = number[j];
    }
  }
  std::vector<double> injection(part.junctions.size()), fixed(part.junctions.size() - unknowns);
  for (std::size_t j = 0; j < part.junctions.size(); ++j) {
    const auto& [id, value, is_fixed] = part.junctions[j];
    (is_fixed ? fixed[number[j] - unknowns] : injection[number[j]]) = value;
  }
  parallel::SharedValues shared(comm, std::move(numbered));
  CoreSystem system(unknowns, std::move(vessels), std::move(injection), fixed, inflow_by_conditions);
  system.share(owned, shared);
  system.start_at(some_pressure(part, comm));

  const auto counts =
      parallel::all_gather(comm, std::vector<std::int64_t>{static_cast<std::int64_t>(owned)}).records;
  const std::int64_t total = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  const std::int64_t first_row =
      std::accumulate(counts.begin(), counts.begin() + comm.rank(), std::int64_t{0});
  if (total > std::numeric_limits<std::int32_t>::max()) {
    throw RunError(std::to_string(total) + " junctions are left after reduction, more than hypre can number");
  }
  CorePartSolution result;
  result.core_junctions = total;
  result.solver = total == 0 ? GraphSolver::elimination : GraphSolver::amg;
  if (total > 0) {
    SharedAmg amg(system, shared, first_row);
    result.iterations = solve_core(system, amg, GraphSolver::amg, options);
  }
  for (std::size_t v = 0; v < part.vessels.size(); ++v) result.flow.push_back(system.flow(v));
  for (const std::uint32_t j : number) result.pressure.push_back(system.pressure(j));
  return result;
}

}  // namespace rhexis::hemodynamics
