// SPDX-License-Identifier: BSD-3-Clause
/// The command line: what was asked for, and doing it.
#pragma once

#include <string>
#include <vector>

#include "parallel/communicator.hpp"

namespace rhexis::app {

enum class Action { run, check, keys, nothing };

struct Command {
  Action action = Action::nothing;
  std::string file;
  std::vector<std::string> overrides;  ///< of --set, "key=value"
  std::string directory;               ///< of -o; empty: results/ and the name of the input file
  std::string restart;                 ///< checkpoint
  std::string section;                 ///< of `keys`
  bool overwrite = false;
  bool quiet = false;
  std::vector<std::string> arguments;  ///< all, the program's name first
  int status = 0;                      ///< exit status where there is nothing to do (help, a wrong call)
};

/// Prints help, version or what is wrong with the call (on the root rank), then leaves nothing to do.
Command parse_command_line(int argc, char** argv, parallel::Communicator comm);

/// Does it and returns the exit status: 0; 128 + signal after an interrupt (as shells have it); 3 where
/// nothing was asked for but text, and it could not be written. Throws InputError and RunError.
int carry_out(const Command& command, parallel::Communicator comm);

}  // namespace rhexis::app
