/// A failure on any rank becomes the same exception on all ranks, so that none waits for another for ever.
#pragma once

#include <exception>
#include <string>

#include "parallel/communicator.hpp"

namespace rhexis::output {

/// Runs `action` on every rank (collective). If it throws on any, every rank throws `Error` with the message
/// of the first rank that failed. The action is either local, or one collective operation: a rank that could
/// throw on its own before a collective call would leave the others waiting in it.
template <class Error, class Action>
void together(const parallel::Communicator& communicator, Action&& action) {
  std::string failure;
  try {
    action();
  } catch (const std::exception& error) {
    failure = error.what();
    if (failure.empty()) failure = "unknown failure";
  }
  failure = communicator.first_non_empty(failure);
  if (!failure.empty()) throw Error(failure);
}

/// As `together`, for an action of the root alone.
template <class Error, class Action>
void on_root(const parallel::Communicator& communicator, Action&& action) {
  together<Error>(communicator, [&] {
    if (communicator.is_root()) action();
  });
}

}  // namespace rhexis::output
