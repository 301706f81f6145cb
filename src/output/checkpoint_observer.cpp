// SPDX-License-Identifier: BSD-3-Clause
#include "output/checkpoint_observer.hpp"

#include "core/error.hpp"

namespace rhexis::output {

void CheckpointObserver::arrive(const Moment& moment) {
  const bool due = plan_.every > 0 && !moment.first && moment.step % plan_.every == 0;
  if (!due && moment.signal == 0) return;
  const std::filesystem::path path = plan_.write(moment.step);
  if (moment.signal != 0) plan_.interrupted(moment.signal, path);
}

void CheckpointObserver::rescue(const Moment& moment) {
  try {
    plan_.failed(plan_.write(moment.step));
  } catch (const RunError& error) {
    plan_.warn(std::string("no checkpoint: ") + error.what());
  }
}

}  // namespace rhexis::output
