// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/halo.hpp"

#include <algorithm>

namespace rhexis::parallel {
namespace {

std::size_t rows_in(const std::vector<Run>& runs) {
  std::size_t count = 0;
  for (const Run& run : runs) count += run.count;
  return count;
}

template <class Real>
void pack(std::span<Real* const> field, const std::vector<Run>& runs, std::vector<Real>& buffer) {
  Real* out = buffer.data();
  for (const Run& run : runs) {
    for (const Real* component : field) out = std::copy_n(component + run.offset, run.count, out);
  }
}

template <class Real>
void unpack(const std::vector<Real>& buffer, const std::vector<Run>& runs, std::span<Real* const> field) {
  const Real* in = buffer.data();
  for (const Run& run : runs) {
    for (Real* component : field) {
      std::copy_n(in, run.count, component + run.offset);
      in += run.count;
    }
  }
}

}  // namespace

template <class Real>
HaloExchange<Real>::HaloExchange(Communicator comm, std::vector<HaloMessage> messages, std::size_t components)
    : comm_(comm), messages_(std::move(messages)) {
  for (const HaloMessage& message : messages_) {
    outgoing_.emplace_back(components * rows_in(message.send));
    incoming_.emplace_back(components * rows_in(message.receive));
  }
}

template <class Real>
void HaloExchange<Real>::start(std::span<Real* const> field) {
  const double started = MPI_Wtime();
  requests_.clear();
  const auto bytes = [](const std::vector<Real>& buffer) {
    return static_cast<int>(buffer.size() * sizeof(Real));
  };
  for (std::size_t m = 0; m < messages_.size(); ++m) {
    if (messages_[m].rank == comm_.rank()) continue;
    MPI_Irecv(incoming_[m].data(), bytes(incoming_[m]), MPI_BYTE, messages_[m].rank, 0, comm_.handle(),
              &requests_.emplace_back());
  }
  for (std::size_t m = 0; m < messages_.size(); ++m) {
    pack(field, messages_[m].send, outgoing_[m]);
    if (messages_[m].rank == comm_.rank()) {
      incoming_[m] = outgoing_[m];
    } else {
      MPI_Isend(outgoing_[m].data(), bytes(outgoing_[m]), MPI_BYTE, messages_[m].rank, 0, comm_.handle(),
                &requests_.emplace_back());
      traffic_.bytes += bytes(outgoing_[m]);
    }
  }
  traffic_.seconds += MPI_Wtime() - started;
}

template <class Real>
void HaloExchange<Real>::finish(std::span<Real* const> field) {
  const double started = MPI_Wtime();
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  for (std::size_t m = 0; m < messages_.size(); ++m) unpack(incoming_[m], messages_[m].receive, field);
  traffic_.seconds += MPI_Wtime() - started;
}

template class HaloExchange<float>;
template class HaloExchange<double>;

}  // namespace rhexis::parallel
