/// A failure on any rank becomes the same exception on all ranks, so that none waits for another for ever.
#pragma once

#include <exception>
#include <string>

#include "core/error.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::parallel {

/// Runs `action` on every rank (collective). If it throws on any, every rank throws `Error` with the message
/// of the first rank that failed. The action is either local, or one collective operation: a rank that could
/// throw on its own before a collective call would leave the others waiting in it.
template <class Error, class Action>
void together(const Communicator& comm, const Action& action) {
  std::string failure;
  try {
    action();
  } catch (const std::exception& error) {
    failure = error.what();
    if (failure.empty()) failure = "unknown failure";
  }
  failure = comm.first_non_empty(failure);
  if (!failure.empty()) throw Error(failure);
}

/// As `together`, for an action of the root alone.
template <class Error, class Action>
void on_root(const Communicator& comm, const Action& action) {
  together<Error>(comm, [&] {
    if (comm.is_root()) action();
  });
}

/// As `together`, for a local action that throws InputError or RunError: the kind is kept, and InputError,
/// which says more, goes first.
template <class Action>
void together(const Communicator& comm, const Action& action) {
  std::string input;
  together<RunError>(comm, [&] {
    try {
      action();
    } catch (const InputError& error) {
      input = error.what();
    }
  });
  input = comm.first_non_empty(input);
  if (!input.empty()) throw InputError(input);
}

}  // namespace rhexis::parallel
