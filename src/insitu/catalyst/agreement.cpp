#include "insitu/catalyst/agreement.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

namespace rhexis::insitu {

Agreement::Agreement(parallel::Communicator communicator) : communicator_(communicator) {
  const char* limit = std::getenv("RHEXIS_SCRIPT_TIMEOUT");
  if (limit != nullptr) limit_s_ = std::strtod(limit, nullptr);
}

std::string Agreement::agree(const std::string& text) {
  await_others(text);
  std::string mine = text;
  if (!mine.empty() && communicator_.size() > 1)
    mine += " (on rank " + std::to_string(communicator_.rank()) + ")";
  const std::string all = communicator_.first_non_empty(mine);
  if (failure_.empty()) failure_ = all;
  return all;
}

void Agreement::await_others(const std::string& text) const {
  MPI_Request arrival = MPI_REQUEST_NULL;
  MPI_Ibarrier(communicator_.handle(), &arrival);
  if (text.empty()) {
    MPI_Wait(&arrival, MPI_STATUS_IGNORE);
    return;
  }
  const auto start = std::chrono::steady_clock::now();
  int arrived = 0;
  while (MPI_Test(&arrival, &arrived, MPI_STATUS_IGNORE) == MPI_SUCCESS && arrived == 0) {
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > limit_s_) {
      std::fprintf(
          stderr,
          "error: %s (on rank %d; the other ranks wait for it inside ParaView, so the run ends here)\n",
          text.c_str(), communicator_.rank());
      std::fflush(nullptr);
      MPI_Abort(communicator_.handle(), 3);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace rhexis::insitu
