// SPDX-License-Identifier: BSD-3-Clause
/// What a call of the module does to the Python process that it is in: as little as can be, and for its own
/// time.
#pragma once

#include <csignal>
#include <memory>
#include <set>
#include <string>

#include "parallel/communicator.hpp"

namespace rhexis::python {

/// The environment and the handlers of signals, to be put back after MPI has started: a program that Python
/// starts later would take itself for a rank of this one, and Python's own handlers are to stay.
class ProcessState {
 public:
  ProcessState();
  void restore() const;

 private:
  std::set<std::string> variables_;
  struct sigaction handlers_[NSIG] {};
};

/// Starts MPI where it does not run yet. Throws RunError where it was started before this process was forked.
void start_mpi();

/// Ends MPI where `start_mpi` has started it. `failed`: Python ends by an exception, perhaps on this rank
/// alone; ranks that do not come to their own end within a moment are ended then.
void end_mpi(bool failed);

/// One call of the module: MPI runs, and OpenMP has the threads that OMP_NUM_THREADS asks for; the caller's
/// number returns with the end of the call. Throws RunError as `start_mpi`, and where another call is at
/// work. Collective.
class Call {
 public:
  Call();
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  std::unique_ptr<parallel::ThreadCount> threads_;
};

}  // namespace rhexis::python
