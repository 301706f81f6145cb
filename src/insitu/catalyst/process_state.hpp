// SPDX-License-Identifier: BSD-3-Clause
/// What a script must leave as it found it, for the solver and its output rely on it.
#pragma once

#include <sys/types.h>

#include <array>
#include <cfenv>
#include <csignal>
#include <filesystem>
#include <map>
#include <string>

namespace rhexis::insitu {

/// The state of the process when this was made: working folder, handlers of signals, timer of SIGALRM, locale
/// of numbers, file mode mask, standard streams, environment variables and rounding of floating-point
/// numbers.
class ProcessState {
 public:
  ProcessState();
  ProcessState(const ProcessState&) = delete;
  ProcessState& operator=(const ProcessState&) = delete;
  ~ProcessState();

  /// Undoes what changed since. Returns what was changed, e.g. "changed the working folder from /a to /",
  /// empty if nothing. New environment variables may stay, but for those that programs started later would
  /// obey. Does not return in a child process that a script forked and let go on: that ends.
  std::string restore() const;

 private:
  struct Stream {
    int copy = -1;
    dev_t device = 0;
    ino_t file = 0;
  };
  static Stream remember(int descriptor);

  pid_t process_;
  std::filesystem::path folder_;
  std::array<struct sigaction, NSIG> handlers_{};
  std::string numbers_;  ///< locale
  mode_t mask_;
  std::array<Stream, 3> streams_;
  std::map<std::string, std::string> environment_;
  std::fenv_t floating_point_{};
};

}  // namespace rhexis::insitu
