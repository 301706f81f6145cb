// SPDX-License-Identifier: BSD-3-Clause
/// How a failure on one rank becomes a failure on all.
#pragma once

#include <functional>
#include <string>

#include "insitu/catalyst/time_limit.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::insitu {

class Agreement {
 public:
  /// `before_abort` is told the reason before the program is ended, on whatever thread finds that it must be.
  /// `time_limit_s`: how long a script may be at work before it is ended; how long ranks that are stuck wait
  /// for each other is RHEXIS_SCRIPT_TIMEOUT (environment variable, seconds).
  Agreement(parallel::Communicator communicator, double time_limit_s,
            std::function<void(const std::string&)> before_abort);

  /// Collective: the first non-empty text in rank order, with the rank's number where there are several; kept
  /// as `failure()` if it is the first. Should this rank have failed and the others not come here within the
  /// limit (they wait for this rank inside ParaView), prints the text and ends the program with status 3.
  std::string agree(const std::string& text);

  const std::string& failure() const { return failure_; }

  bool is_root() const { return communicator_.is_root(); }

  /// The limit is one of the scripts' own work; what they wait for here does not count.
  TimeLimit& time_limit() { return time_limit_; }

 private:
  void await_others(const std::string& text) const;
  [[noreturn]] void end_program(const std::string& reason) const;

  parallel::Communicator communicator_;
  std::function<void(const std::string&)> before_abort_;
  double stuck_limit_s_;
  std::string failure_;
  TimeLimit time_limit_;  ///< last: its thread uses the others
};

}  // namespace rhexis::insitu
