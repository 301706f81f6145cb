// SPDX-License-Identifier: BSD-3-Clause
// rhexis: parse, build, run, report.
#include "app/commands.hpp"
#include "parallel/communicator.hpp"
#include "runtime/guarded.hpp"
#include "runtime/interrupt.hpp"
#include "runtime/terminal.hpp"

/// The loader calls what stands here before the constructors of shared libraries.
[[gnu::section(".preinit_array"),
  gnu::used]] static void (*const before_libraries)() = rhexis::runtime::note_ignored_hangup;

int main(int argc, char** argv) {
  rhexis::runtime::open_missing_streams();
  rhexis::runtime::prepare_signals();
  const rhexis::parallel::Session session(argc, argv);
  const auto world = rhexis::parallel::Communicator::world();
  const rhexis::app::Command command = rhexis::app::parse_command_line(argc, argv, world);
  if (command.action == rhexis::app::Action::nothing) return command.status;
  return rhexis::runtime::guarded(world, [&] { return rhexis::app::carry_out(command, world); });
}
