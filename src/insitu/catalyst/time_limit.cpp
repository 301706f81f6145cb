// SPDX-License-Identifier: BSD-3-Clause
// Before any other header; not vtkPython.h, which makes nothing of the interpreter's lock.
#include "insitu/catalyst/time_limit.hpp"

#include <Python.h>
#include <pthread.h>

#include <algorithm>
#include <csignal>

#include "core/format.hpp"

namespace rhexis::insitu {
namespace {

/// A thread that no signal is delivered to: they are for the solver's.
template <class Work>
std::thread quiet_thread(Work work) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::move(work));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace

TimeLimit::TimeLimit(double limit_s, double grace_s, std::function<void(const std::string&)> end_program)
    : limit_s_(std::min(limit_s, 1e9)),
      grace_s_(grace_s),
      python_thread_(PyThread_get_thread_ident()),
      end_program_(std::move(end_program)) {
  thread_ = quiet_thread([this] { watch(); });
}

TimeLimit::~TimeLimit() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->over = true;
    state_->at_work = false;
  }
  state_->changed.notify_one();
  thread_.join();
}

std::string TimeLimit::limit() const {
  return text(limit_s_) + " s";
}

void TimeLimit::begin(const std::string& path) {
  const std::lock_guard lock(state_->mutex);
  state_->path = path;
  state_->began = Clock::now();
  state_->at_work = true;
  state_->changed.notify_one();
}

void TimeLimit::end() {
  const std::lock_guard lock(state_->mutex);
  state_->at_work = false;
}

TimeLimit::Pause::Pause(TimeLimit& limit) : limit_(limit) {
  const std::lock_guard lock(limit_.state_->mutex);
  was_at_work_ = limit_.state_->at_work;
  limit_.state_->at_work = false;
}

TimeLimit::Pause::~Pause() {
  // What was waited for was not this script's time: it begins anew.
  if (was_at_work_) limit_.begin(limit_.state_->path);
}

/// By a thread that waits for the interpreter's lock, for as long as the script is inside a library that
/// keeps it.
void TimeLimit::interrupt() {
  state_->interrupting = true;
  quiet_thread([state = state_, thread = python_thread_] {
    PyGILState_STATE lock = PyGILState_Ensure();
    {
      const std::lock_guard guard(state->mutex);
      state->interrupting = false;
      PyObject* names = PyModule_GetDict(PyImport_AddModule("rhexis_catalyst"));
      if (state->at_work) PyThreadState_SetAsyncExc(thread, PyDict_GetItemString(names, "TimeIsUp"));
    }
    PyGILState_Release(lock);
  }).detach();
}

void TimeLimit::watch() {
  const auto after = [&](double s) {
    return state_->began + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  };
  std::unique_lock lock(state_->mutex);
  while (!state_->over) {
    if (!state_->at_work) {
      state_->changed.wait(lock);
    } else if (Clock::now() < after(limit_s_)) {
      state_->changed.wait_until(lock, after(limit_s_));
    } else if (Clock::now() < after(limit_s_ + grace_s_)) {
      if (!state_->interrupting) interrupt();
      state_->changed.wait_for(lock, std::chrono::seconds(1));  // a script may catch the exception, and go on
    } else {
      const std::string reason =
          "Catalyst script " + state_->path + ": not done after " + limit() + " (insitu.time_limit)";
      state_->at_work = false;
      lock.unlock();
      end_program_(reason);
      lock.lock();
    }
  }
}

}  // namespace rhexis::insitu
