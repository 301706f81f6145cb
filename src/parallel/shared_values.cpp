// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/shared_values.hpp"

#include <utility>

namespace rhexis::parallel {

SharedValues::SharedValues(Communicator comm, std::vector<SharedLink> links)
    : comm_(comm), links_(std::move(links)), outgoing_(links_.size()), incoming_(links_.size()) {}

void SharedValues::exchange(std::span<const double> values, bool from_owner) {
  std::vector<MPI_Request> requests;
  requests.reserve(2 * links_.size());
  const auto start = [&](auto transfer, std::vector<double>& buffer, int rank) {
    if (buffer.empty()) return;
    transfer(buffer.data(), static_cast<int>(buffer.size()), MPI_DOUBLE, rank, 0, comm_.handle(),
             &requests.emplace_back());
  };
  for (std::size_t n = 0; n < links_.size(); ++n) {
    const auto& [rank, owned, borrowed] = links_[n];
    incoming_[n].resize(from_owner ? borrowed.size() : owned.size());
    start(MPI_Irecv, incoming_[n], rank);
  }
  for (std::size_t n = 0; n < links_.size(); ++n) {
    const auto& [rank, owned, borrowed] = links_[n];
    outgoing_[n].clear();
    for (const std::uint32_t index : from_owner ? owned : borrowed) outgoing_[n].push_back(values[index]);
    start(MPI_Isend, outgoing_[n], rank);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

void SharedValues::copy_from_owner(std::span<double> values) {
  exchange(values, true);
  for (std::size_t n = 0; n < links_.size(); ++n) {
    const auto& borrowed = links_[n].borrowed;
    for (std::size_t i = 0; i < borrowed.size(); ++i) values[borrowed[i]] = incoming_[n][i];
  }
}

void SharedValues::add_to_owner(std::span<double> values) {
  exchange(values, false);
  for (std::size_t n = 0; n < links_.size(); ++n) {
    const auto& owned = links_[n].owned;
    for (std::size_t i = 0; i < owned.size(); ++i) values[owned[i]] += incoming_[n][i];
  }
}

}  // namespace rhexis::parallel
