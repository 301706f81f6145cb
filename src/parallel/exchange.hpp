/// Collective exchange of records (trivially copyable, fewer than 2^31 from or to one rank).
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <type_traits>
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

/// An MPI type of `bytes` bytes, so that counts are records.
class RecordType {
 public:
  explicit RecordType(std::size_t bytes) {
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &handle_);
    MPI_Type_commit(&handle_);
  }
  ~RecordType() { MPI_Type_free(&handle_); }
  RecordType(const RecordType&) = delete;
  RecordType& operator=(const RecordType&) = delete;
  MPI_Datatype handle() const { return handle_; }

 private:
  MPI_Datatype handle_ = MPI_DATATYPE_NULL;
};

/// Sends outgoing[r] to every rank r; returns what all ranks sent to this one, each rank's in its order.
template <class T>
ByRank<T> all_to_all(Communicator comm, const std::vector<std::vector<T>>& outgoing) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<int> count(ranks), start(ranks + 1), incoming(ranks);
  std::vector<T> packed;
  for (std::size_t r = 0; r < ranks; ++r) {
    count[r] = static_cast<int>(outgoing[r].size());
    packed.insert(packed.end(), outgoing[r].begin(), outgoing[r].end());
  }
  std::inclusive_scan(count.begin(), count.end(), start.begin() + 1);
  MPI_Alltoall(count.data(), 1, MPI_INT, incoming.data(), 1, MPI_INT, comm.handle());
  ByRank<T> result{{}, std::vector<int>(ranks + 1)};
  std::inclusive_scan(incoming.begin(), incoming.end(), result.start.begin() + 1);
  result.records.resize(static_cast<std::size_t>(result.start.back()));
  const RecordType type(sizeof(T));
  MPI_Alltoallv(packed.data(), count.data(), start.data(), type.handle(), result.records.data(),
                incoming.data(), result.start.data(), type.handle(), comm.handle());
  return result;
}

/// The records of all ranks, on every rank.
template <class T>
ByRank<T> all_gather(Communicator comm, const std::vector<T>& mine) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto ranks = static_cast<std::size_t>(comm.size());
  const int own = static_cast<int>(mine.size());
  std::vector<int> count(ranks);
  MPI_Allgather(&own, 1, MPI_INT, count.data(), 1, MPI_INT, comm.handle());
  ByRank<T> result{{}, std::vector<int>(ranks + 1)};
  std::inclusive_scan(count.begin(), count.end(), result.start.begin() + 1);
  result.records.resize(static_cast<std::size_t>(result.start.back()));
  const RecordType type(sizeof(T));
  MPI_Allgatherv(mine.data(), own, type.handle(), result.records.data(), count.data(), result.start.data(),
                 type.handle(), comm.handle());
  return result;
}

}  // namespace rhexis::parallel
