// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/agreement.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <limits>

namespace rhexis::insitu {
namespace {

/// Seconds that a rank whose script failed waits for the others.
double stuck_limit_s() {
  const char* limit = std::getenv("RHEXIS_SCRIPT_TIMEOUT");
  return limit != nullptr ? std::strtod(limit, nullptr) : 60;
}

}  // namespace

Agreement::Agreement(parallel::Communicator communicator, double time_limit_s,
                     std::function<void(const std::string&)> before_abort)
    : communicator_(communicator),
      before_abort_(std::move(before_abort)),
      stuck_limit_s_(stuck_limit_s()),
      // A rank whose script could be interrupted knows its line: it ends the program before those that wait
      // for it.
      time_limit_(time_limit_s, stuck_limit_s_ + 2,
                  [this](const std::string& reason) { end_program(reason); }) {}

void Agreement::end_program(const std::string& reason) const {
  std::fprintf(stderr, "error: %s\n", reason.c_str());
  std::fflush(nullptr);
  if (before_abort_) before_abort_(reason);
  if (communicator_.size() == 1) _exit(3);
  communicator_.abort(3);
}

std::string Agreement::agree(const std::string& text) {
  const TimeLimit::Pause waits(time_limit_);
  await_others(text);
  std::string mine = text;
  if (!mine.empty() && communicator_.size() > 1)
    mine += " (on rank " + std::to_string(communicator_.rank()) + ")";
  const std::string all = communicator_.first_non_empty(mine);
  if (failure_.empty()) failure_ = all;
  return all;
}

void Agreement::await_others(const std::string& text) const {
  const double patience = text.empty() ? std::numeric_limits<double>::infinity() : stuck_limit_s_;
  if (!communicator_.barrier_within(patience)) {
    end_program(text + " (on rank " + std::to_string(communicator_.rank()) +
                "; the other ranks wait for it inside ParaView, so the run ends here)");
  }
}

}  // namespace rhexis::insitu
