// SPDX-License-Identifier: BSD-3-Clause
/// What the program can be asked for, by the command line or by another program (python/), and doing it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "parallel/communicator.hpp"
#include "runtime/run_options.hpp"

namespace rhexis::app {

enum class Action { run, check, network, keys, nothing };

struct Command {
  Action action = Action::nothing;
  std::string file;
  std::vector<std::string> network_files;  ///< of `rhexis network`: a scene, or the files of a network
  std::string length_unit;                 ///< the argument of --length-unit
  std::string picture;                     ///< the argument of --picture
  std::vector<std::string> overrides;      ///< the arguments of --set, each "key=value"
  std::string directory;  ///< the argument of -o; empty: results/ and the name of the input file
                          ///< (of `rhexis network`, which writes a file there: nothing)
  std::string restart;    ///< checkpoint
  std::string section;    ///< the argument of `rhexis keys`
  bool overwrite = false;
  bool quiet = false;
  bool embedded = false;               ///< in another program: runtime::RunOptions
  std::vector<std::string> arguments;  ///< all, the program's name first
  int status = 0;                      ///< exit status where there is nothing to do (help, a wrong call)
};

/// Prints help, version or what is wrong with the call (on the root rank), then leaves nothing to do.
Command parse_command_line(int argc, char** argv, parallel::Communicator comm);

/// What `check` finds: {"model", "input" (as resolved), "warnings"} and, of a scene whose wall is known
/// before it is run, "particles", "steps", "time_step_s" and "stable_time_step_s". Collective. Throws
/// InputError.
nlohmann::ordered_json checked_values(const Command& command, parallel::Communicator comm);

/// Runs what command.file describes. Collective. Throws InputError and RunError.
runtime::Ending run(const Command& command, parallel::Communicator comm,
                    runtime::OutputFunction on_output = {});

/// Does what the command line asks for and returns the exit status: 0; 128 + signal after an interrupt (as
/// shells have it); 3 where nothing was asked for but text, and it could not be written. Throws InputError
/// and RunError.
int carry_out(const Command& command, parallel::Communicator comm);

}  // namespace rhexis::app
