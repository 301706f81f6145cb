// SPDX-License-Identifier: BSD-3-Clause
/// Failures turned into one message and an exit status, the same on every rank.
#pragma once

#include <fmt/format.h>

#include <exception>

#include "core/error.hpp"
#include "core/printable.hpp"
#include "parallel/communicator.hpp"
#include "runtime/terminal.hpp"

namespace rhexis::runtime {

/// Bytes of a message at most: what it quotes may be as long as a file.
constexpr std::size_t longest_message = 4000;

/// Ends the program on all ranks for a failure that only this rank knows of.
[[noreturn]] inline void abort_because_of(const std::exception& error, parallel::Communicator comm) {
  print_error(
      fmt::format("rhexis: rank {}: {}\n", comm.rank(), printable(reason_of(error), longest_message)));
  comm.abort(3);
}

/// Runs `work` and returns its exit status, or 2 for wrong input, or 3 for a failure while running. Both
/// kinds of error are thrown on all ranks together, so one of them speaks; anything else is one rank's own
/// and ends the program for all.
template <class Work>
int guarded(parallel::Communicator comm, const Work& work) {
  const auto say = [&](const char* what) {
    if (comm.is_root()) print_error(fmt::format("rhexis: {}\n", printable(what, longest_message)));
  };
  try {
    return work();
  } catch (const InputError& error) {
    say(error.what());
    return 2;
  } catch (const RunError& error) {
    say(error.what());
    return 3;
  } catch (const std::exception& error) {
    abort_because_of(error, comm);
  }
}

}  // namespace rhexis::runtime
