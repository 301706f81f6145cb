// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/exchange.hpp"

#include <numeric>

namespace rhexis::parallel {
namespace {

/// An MPI type of `bytes` bytes, so that counts are in records.
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

}  // namespace

RecordRuns runs_of(std::vector<int> count) {
  std::vector<int> start(count.size() + 1);
  std::inclusive_scan(count.begin(), count.end(), start.begin() + 1);
  return {std::move(count), std::move(start)};
}

RecordRuns incoming_runs(Communicator comm, const std::vector<int>& outgoing) {
  std::vector<int> incoming(outgoing.size());
  MPI_Alltoall(outgoing.data(), 1, MPI_INT, incoming.data(), 1, MPI_INT, comm.handle());
  return runs_of(std::move(incoming));
}

RecordRuns gathered_runs(Communicator comm, int own) {
  std::vector<int> count(static_cast<std::size_t>(comm.size()));
  MPI_Allgather(&own, 1, MPI_INT, count.data(), 1, MPI_INT, comm.handle());
  return runs_of(std::move(count));
}

void exchange_records(Communicator comm, std::size_t record_bytes, const void* outgoing,
                      const RecordRuns& outgoing_runs, void* incoming, const RecordRuns& incoming_runs) {
  const RecordType type(record_bytes);
  MPI_Alltoallv(outgoing, outgoing_runs.count.data(), outgoing_runs.start.data(), type.handle(), incoming,
                incoming_runs.count.data(), incoming_runs.start.data(), type.handle(), comm.handle());
}

void gather_records(Communicator comm, std::size_t record_bytes, const void* mine, int own, void* gathered,
                    const RecordRuns& runs) {
  const RecordType type(record_bytes);
  MPI_Allgatherv(mine, own, type.handle(), gathered, runs.count.data(), runs.start.data(), type.handle(),
                 comm.handle());
}

}  // namespace rhexis::parallel
