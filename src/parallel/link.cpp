// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/link.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace rhexis::parallel {
namespace {

/// Seconds that `bytes` take one way, the best of `rounds`; known to the first rank.
double one_way(const Communicator& comm, int bytes, int rounds) {
  const int last = comm.size() - 1;
  std::vector<char> message(static_cast<std::size_t>(bytes));
  double best = std::numeric_limits<double>::infinity();
  comm.barrier();
  for (int round = 0; round < rounds; ++round) {
    const double start = MPI_Wtime();
    if (comm.is_root()) {
      MPI_Send(message.data(), bytes, MPI_CHAR, last, 0, comm.handle());
      MPI_Recv(message.data(), bytes, MPI_CHAR, last, 0, comm.handle(), MPI_STATUS_IGNORE);
    } else if (comm.rank() == last) {
      MPI_Recv(message.data(), bytes, MPI_CHAR, 0, 0, comm.handle(), MPI_STATUS_IGNORE);
      MPI_Send(message.data(), bytes, MPI_CHAR, 0, 0, comm.handle());
    }
    best = std::min(best, 0.5 * (MPI_Wtime() - start));
  }
  return best;
}

}  // namespace

std::optional<Link> measure_link(const Communicator& comm) {
  if (comm.size() == 1) return {};
  constexpr int long_message = 1 << 20;
  double seconds[2] = {one_way(comm, 0, 50), one_way(comm, long_message, 5)};
  if (!comm.is_root()) seconds[0] = seconds[1] = 0;
  comm.all_reduce(seconds, Reduce::max);
  const double rest = seconds[1] - seconds[0];
  return Link{seconds[0], long_message / (rest > 0 ? rest : seconds[1])};
}

}  // namespace rhexis::parallel
