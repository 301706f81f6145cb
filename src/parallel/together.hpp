/// A failure on any rank becomes the same exception on all ranks, so that none waits for another for ever.
#pragma once

#include <string>

#include "core/error.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::parallel {

/// Runs `action`, which is local, on every rank (collective). If it throws InputError or RunError on any,
/// every rank throws that with the message of the first such rank; InputError goes first.
template <class Action>
void together(Communicator comm, const Action& action) {
  std::string input, run;
  try {
    action();
  } catch (const InputError& error) {
    input = error.what();
  } catch (const RunError& error) {
    run = error.what();
  }
  input = comm.first_non_empty(input);
  if (!input.empty()) throw InputError(input);
  run = comm.first_non_empty(run);
  if (!run.empty()) throw RunError(run);
}

}  // namespace rhexis::parallel
