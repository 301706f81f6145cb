// SPDX-License-Identifier: BSD-3-Clause
/// Collective exchange of records (trivially copyable, fewer than 2^31 from or to one rank).
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "parallel/communicator.hpp"

namespace rhexis::parallel {

/// Records of several ranks one after another: those of rank r are [start[r], start[r+1]).
template <class T>
struct ByRank {
  std::vector<T> records;
  std::vector<int> start;

  std::span<const T> of(int rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return std::span(records).subspan(static_cast<std::size_t>(start[r]),
                                      static_cast<std::size_t>(start[r + 1] - start[r]));
  }
};

/// How many records come from, or go to, each rank.
struct RecordRuns {
  std::vector<int> count;  ///< [ranks]
  std::vector<int> start;  ///< [ranks + 1], the running sum of `count`
};

/// How many records every rank has for this one, where this one has outgoing[r] for rank r. Collective.
RecordRuns incoming_runs(Communicator comm, const std::vector<int>& outgoing);
/// How many records every rank has, where this one has `own`. Collective.
RecordRuns gathered_runs(Communicator comm, int own);
/// Sends `outgoing` to all ranks and fills `incoming`, both packed rank by rank. Collective.
void exchange_records(Communicator comm, std::size_t record_bytes, const void* outgoing,
                      const RecordRuns& outgoing_runs, void* incoming, const RecordRuns& incoming_runs);
/// Fills `gathered` with the `own` records of every rank. Collective.
void gather_records(Communicator comm, std::size_t record_bytes, const void* mine, int own, void* gathered,
                    const RecordRuns& runs);
/// The running sum of `count`, from 0.
RecordRuns runs_of(std::vector<int> count);

/// Sends outgoing[r] to every rank r; returns what all ranks sent to this one, each rank's in its order.
template <class T>
ByRank<T> all_to_all(Communicator comm, const std::vector<std::vector<T>>& outgoing) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<int> count;
  std::vector<T> packed;
  for (const std::vector<T>& records : outgoing) {
    count.push_back(static_cast<int>(records.size()));
    packed.insert(packed.end(), records.begin(), records.end());
  }
  const RecordRuns runs = runs_of(std::move(count));
  const RecordRuns incoming = incoming_runs(comm, runs.count);
  ByRank<T> result{std::vector<T>(static_cast<std::size_t>(incoming.start.back())), incoming.start};
  exchange_records(comm, sizeof(T), packed.data(), runs, result.records.data(), incoming);
  return result;
}

/// The records of all ranks, on every rank.
template <class T>
ByRank<T> all_gather(Communicator comm, const std::vector<T>& mine) {
  static_assert(std::is_trivially_copyable_v<T>);
  const int own = static_cast<int>(mine.size());
  const RecordRuns runs = gathered_runs(comm, own);
  ByRank<T> result{std::vector<T>(static_cast<std::size_t>(runs.start.back())), runs.start};
  gather_records(comm, sizeof(T), mine.data(), own, result.records.data(), runs);
  return result;
}

}  // namespace rhexis::parallel
