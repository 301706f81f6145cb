// SPDX-License-Identifier: BSD-3-Clause
/// A failure on any rank becomes the same exception on all ranks, so that none waits for another for ever.
#pragma once

#include <exception>
#include <string>
#include <type_traits>

#include "core/error.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::parallel {

/// What an exception says, in one text that ranks can tell each other; never empty.
struct Failure {
  static constexpr char end_of_key = '\0';
  static std::string text(const std::exception& error) {
    const auto* input = dynamic_cast<const InputError*>(&error);
    return (input != nullptr ? input->key : std::string()) + end_of_key + reason_of(error);
  }
  template <class Error>
  [[noreturn]] static void raise(const std::string& text) {
    const std::size_t end = text.find(end_of_key);
    if constexpr (std::is_same_v<Error, InputError>)
      throw InputError(text.substr(end + 1), text.substr(0, end));
    throw Error(text.substr(end + 1));
  }
};

/// Runs `action` on every rank (collective). If it throws on any, every rank throws `Error` with the message
/// (and key) of the first rank that failed. The action is either local, or one collective operation: a rank
/// that could throw on its own before a collective call would leave the others waiting in it.
template <class Error, class Action>
void together(const Communicator& comm, const Action& action) {
  std::string failure;
  try {
    action();
  } catch (const std::exception& error) {
    failure = Failure::text(error);
  }
  failure = comm.first_non_empty(failure);
  if (!failure.empty()) Failure::raise<Error>(failure);
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
  std::string input, other;
  try {
    action();
  } catch (const InputError& error) {
    input = Failure::text(error);
  } catch (const std::exception& error) {
    other = Failure::text(error);
  }
  input = comm.first_non_empty(input);
  if (!input.empty()) Failure::raise<InputError>(input);
  other = comm.first_non_empty(other);
  if (!other.empty()) Failure::raise<RunError>(other);
}

}  // namespace rhexis::parallel
