// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/junction_directory.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "parallel/exchange.hpp"
#include "parallel/together.hpp"

namespace rhexis::hemodynamics {
namespace {

using network::BoundaryCondition;

/// To the directory: a rank has a junction; a rank knows something of it.
struct Report {
  std::int64_t id;
  std::uint32_t local;
  std::int32_t rank;
  bool has_vessels;
};
struct ReportedCondition {
  std::int64_t id;
  BoundaryCondition condition;
};

/// From the directory: `other` has the junction too, and one of the two owns it.
struct Sharing {
  std::int64_t id;
  std::uint32_t local;
  std::int32_t other;
  bool owned, connected;
};
struct KnownCondition {
  BoundaryCondition condition;  // at the local junction
  bool owned;
};

template <class T>
using Outgoing = std::vector<std::vector<T>>;

bool differ(const BoundaryCondition& a, const BoundaryCondition& b) {
  return a.kind != b.kind || a.value != b.value || a.resistance != b.resistance;
}

void answer(std::span<const Report> holders, std::span<const ReportedCondition> known,
            Outgoing<Sharing>& sharing, Outgoing<KnownCondition>& conditions, int ranks) {
  const std::int64_t id = holders.front().id;
  const std::string name = "junction " + std::to_string(id);
  const bool connected =
      std::any_of(holders.begin(), holders.end(), [](const Report& r) { return r.has_vessels; });
  // Spreads owners over ranks.
  const Report& owner = holders[static_cast<std::size_t>(id / ranks) % holders.size()];
  for (std::size_t n = 1; n < holders.size(); ++n) {
    if (holders[n].rank == holders[n - 1].rank) throw InputError(name + " comes twice on one rank");
  }
  for (const Report& holder : holders) {
    if (holder.rank == owner.rank) continue;
    sharing[static_cast<std::size_t>(owner.rank)].push_back({id, owner.local, holder.rank, true, connected});
    sharing[static_cast<std::size_t>(holder.rank)].push_back(
        {id, holder.local, owner.rank, false, connected});
  }
  if (known.empty()) return;
  for (const ReportedCondition& other : known) {
    if (differ(other.condition, known.front().condition))
      throw InputError(name + " has two conditions; give one");
  }
  BoundaryCondition condition = known.front().condition;
  if (condition.kind == BoundaryCondition::Kind::flow && !connected)
    throw_inflow_without_vessels(std::to_string(id));
  for (const Report& holder : holders) {
    condition.junction = holder.local;
    conditions[static_cast<std::size_t>(holder.rank)].push_back({condition, holder.rank == owner.rank});
  }
}

/// The directory's work: ids in ascending order, each with its holders by rank and its conditions.
void answer_all(std::vector<Report>& reports, std::vector<ReportedCondition>& known,
                Outgoing<Sharing>& sharing, Outgoing<KnownCondition>& conditions, int ranks) {
  std::sort(reports.begin(), reports.end(), [](const Report& a, const Report& b) {
    return std::pair(a.id, a.rank) < std::pair(b.id, b.rank);
  });
  std::stable_sort(known.begin(), known.end(),
                   [](const ReportedCondition& a, const ReportedCondition& b) { return a.id < b.id; });
  std::size_t first_known = 0;
  for (std::size_t first = 0; first < reports.size();) {
    const std::int64_t id = reports[first].id;
    std::size_t past = first, past_known = first_known;
    while (past < reports.size() && reports[past].id == id) ++past;
    while (past_known < known.size() && known[past_known].id == id) ++past_known;
    answer(std::span(reports).subspan(first, past - first),
           std::span(known).subspan(first_known, past_known - first_known), sharing, conditions, ranks);
    first = past;
    first_known = past_known;
  }
}

void check_ids(const network::Graph& local, std::span<const std::int64_t> junction_id) {
  if (junction_id.size() != local.junctions) {
    throw InputError("a rank has " + std::to_string(local.junctions) + " junctions but " +
                     std::to_string(junction_id.size()) + " ids");
  }
  for (const std::int64_t id : junction_id) {
    if (id < 0) throw InputError("junction id " + std::to_string(id) + " is negative");
  }
}

std::vector<parallel::SharedLink> links_of(std::vector<Sharing> sharing) {
  // Directories answer in their own order; by id, both sides of a link agree.
  std::sort(sharing.begin(), sharing.end(), [](const Sharing& a, const Sharing& b) { return a.id < b.id; });
  std::map<int, parallel::SharedLink> links;
  for (const Sharing& shared : sharing) {
    auto& link = links[shared.other];
    link.rank = shared.other;
    (shared.owned ? link.owned : link.borrowed).push_back(shared.local);
  }
  std::vector<parallel::SharedLink> result;
  for (auto& [rank, link] : links) result.push_back(std::move(link));
  return result;
}

Boundary boundary_of(const std::vector<KnownCondition>& known) {
  Boundary boundary;
  for (const auto& [condition, owned] : known) {
    const std::uint32_t j = condition.junction;
    if (condition.kind == BoundaryCondition::Kind::pressure && condition.resistance == 0) {
      boundary.fixed.push_back({j, condition.value});
    } else if (owned && condition.kind == BoundaryCondition::Kind::pressure) {
      boundary.ghosts.push_back({j, condition.value, 1 / condition.resistance});
    } else if (owned) {
      boundary.inflows.push_back({j, condition.value});
    }
  }
  // In local order, so that the order of answers does not matter.
  std::sort(boundary.fixed.begin(), boundary.fixed.end(),
            [](const auto& a, const auto& b) { return a.junction < b.junction; });
  return boundary;
}

}  // namespace

JunctionDirectory look_up(const network::Graph& local, std::span<const std::int64_t> junction_id,
                          std::span<const BoundaryCondition> conditions, parallel::Communicator comm) {
  const int ranks = comm.size();
  const auto directory = [&](std::int64_t id) { return static_cast<std::size_t>(id % ranks); };
  JunctionDirectory result;
  parallel::together(comm, [&] {
    check_ids(local, junction_id);
    sort_conditions(local, conditions, [&](std::size_t j) { return std::to_string(junction_id[j]); });
  });
  result.connected = junctions_with_vessels(local);
  Outgoing<Report> reports(static_cast<std::size_t>(ranks));
  for (std::uint32_t j = 0; j < local.junctions; ++j) {
    reports[directory(junction_id[j])].push_back({junction_id[j], j, comm.rank(), result.connected[j]});
  }
  Outgoing<ReportedCondition> known(static_cast<std::size_t>(ranks));
  for (const BoundaryCondition& condition : conditions) {
    const std::int64_t id = junction_id[condition.junction];
    known[directory(id)].push_back({id, condition});
  }
  auto all_reports = parallel::all_to_all(comm, reports).records;
  reports = {};
  auto all_known = parallel::all_to_all(comm, known).records;
  Outgoing<Sharing> sharing(static_cast<std::size_t>(ranks));
  Outgoing<KnownCondition> answers(static_cast<std::size_t>(ranks));
  parallel::together(comm, [&] { answer_all(all_reports, all_known, sharing, answers, ranks); });
  const auto my_sharing = parallel::all_to_all(comm, sharing).records;
  for (const Sharing& shared : my_sharing) result.connected[shared.local] = shared.connected;
  result.links = links_of(my_sharing);
  result.boundary = boundary_of(parallel::all_to_all(comm, answers).records);
  return result;
}

}  // namespace rhexis::hemodynamics
