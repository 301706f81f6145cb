// SPDX-License-Identifier: BSD-3-Clause
#include "host.hpp"

#include <unistd.h>

#include <cstdlib>

#include "core/error.hpp"

namespace rhexis::python {
namespace {

std::unique_ptr<parallel::MpiLibrary> mpi;
pid_t process_of_mpi = 0;
bool at_work = false;  // read and written by who holds Python's lock

template <class Visit>
void for_each_variable(const Visit& visit) {
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string text = *entry;
    visit(text.substr(0, text.find('=')));
  }
}

}  // namespace

ProcessState::ProcessState() {
  for_each_variable([&](const std::string& name) { variables_.insert(name); });
  for (int signal = 1; signal < NSIG; ++signal) sigaction(signal, nullptr, &handlers_[signal]);
}

void ProcessState::restore() const {
  std::set<std::string> added;
  for_each_variable([&](const std::string& name) {
    // Open MPI reads it when the first file is opened (parallel/communicator.cpp).
    if (!variables_.contains(name) && name != "OMPI_MCA_sharedfp") added.insert(name);
  });
  for (const std::string& name : added) unsetenv(name.c_str());
  for (int signal = 1; signal < NSIG; ++signal) sigaction(signal, &handlers_[signal], nullptr);
}

void start_mpi() {
  if (mpi && process_of_mpi != getpid())
    throw RunError(
        "MPI was started before this process was forked, and cannot be used in it: use processes that are "
        "spawned (multiprocessing.get_context(\"spawn\")), or call rhexis in the new processes only");
  if (mpi) return;
  static int no_arguments = 0;
  static char** arguments = nullptr;
  const ProcessState before;
  mpi = std::make_unique<parallel::MpiLibrary>(no_arguments, arguments);
  process_of_mpi = getpid();
  before.restore();
}

Call::Call() {
  if (at_work) throw RunError("a call of rhexis is at work in this process: one at a time");
  start_mpi();
  threads_ = std::make_unique<parallel::ThreadCount>();
  at_work = true;
}

Call::~Call() {
  at_work = false;
}

void end_mpi(bool failed) {
  if (!mpi || process_of_mpi != getpid()) return;
  constexpr double moment_s = 2;
  const parallel::Communicator world = parallel::Communicator::world();
  if (failed && world.size() > 1 && !world.barrier_within(moment_s)) world.abort(1);
  mpi.reset();
}

}  // namespace rhexis::python
