// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/interrupt.hpp"

#include <fmt/format.h>
#include <semaphore.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <thread>
#include <vector>

#include "output/temporary_file.hpp"
#include "runtime/terminal.hpp"

namespace rhexis::runtime {
namespace {

constexpr std::array watched = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU};
constexpr std::array names = {"SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGXCPU"};

std::size_t place_of(int signal) {
  return static_cast<std::size_t>(std::find(watched.begin(), watched.end(), signal) - watched.begin());
}

/// Batch systems send them ahead of the end, some again and again.
bool is_advance_notice(int signal) {
  return signal == SIGUSR1 || signal == SIGXCPU;
}

bool hangup_was_ignored = false;  ///< when the program started, as nohup has it

// What the handler touches.
std::atomic<int> first_signal = 0, guards = 0;
std::array<std::atomic<int>, watched.size()> noted{};  ///< how often, while a guard lived
std::atomic<int> fatal = 0;                            ///< signal that came without one
std::atomic<bool> leave = false;                       ///< the thread's work is done
std::atomic<bool> is_embedded = false;                 ///< signals are left to the run without a guard too
sem_t wake;

extern "C" void note_signal(int signal) {
  const int error = errno;
  int none = 0;
  first_signal.compare_exchange_strong(none, signal);
  if (guards > 0 || is_embedded) {
    ++noted[place_of(signal)];
  } else {
    fatal = signal;
  }
  sem_post(&wake);
  errno = error;
}

/// What signals come to, apart from the run itself.
class Watch {
 public:
  static Watch& instance() {
    static Watch& watch = *new Watch;  // outlives all threads
    return watch;
  }

  void start(const std::filesystem::path& folder, bool writes, bool embedded) {
    const std::lock_guard lock(mutex_);
    if (++runs_ > 1) return;  // a run within a run, in a folder within its folder
    folder_ = folder;
    writes_ = writes;
    is_embedded = embedded;
    forget_signals();
    for (std::size_t i = 0; i < watched.size(); ++i) sigaction(watched[i], nullptr, &before_[i]);
    catch_signals();
    leave = false;
    thread_ = std::thread([this] { watch(); });
  }

  void add(output::RunRecord& record) {
    const std::lock_guard lock(mutex_);
    records_.push_back(&record);
    // The signal came before there was a record to tell of it.
    if (const int signal = first_signal; signal != 0 && writes_)
      record.fail_alone(interrupted_unsaved(signal));
  }

  void stop(const output::RunRecord* record) {
    {
      const std::lock_guard lock(mutex_);
      std::erase(records_, record);
      if (--runs_ > 0) return;
      for (std::size_t i = 0; i < watched.size(); ++i) sigaction(watched[i], &before_[i], nullptr);
    }
    leave = true;
    sem_post(&wake);
    thread_.join();
  }

  /// Installs our handlers, again where a library has put its own in between.
  void catch_signals() {
    struct sigaction action = {};
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < watched.size(); ++i) {
      const bool stays_ignored =
          is_embedded ? before_[i].sa_handler == SIG_IGN : watched[i] == SIGHUP && hangup_was_ignored;
      action.sa_handler = stays_ignored ? SIG_IGN : note_signal;
      sigaction(watched[i], &action, nullptr);
    }
  }

  void fail_records(const std::string& reason) noexcept {
    const std::lock_guard lock(mutex_);
    for (output::RunRecord* record : records_) record->fail_alone(reason);
  }

 private:
  Watch() { sem_init(&wake, 0, 0); }

  static std::string interrupted_unsaved(int signal) {
    return interrupted_by(signal) + ", and ended before its state was saved";
  }

  /// Forgets the signals of an earlier run in the same process.
  void forget_signals() {
    first_signal = fatal = 0;
    for (auto& times : noted) times = 0;
    seen_.fill(0);
    count_ = repetitions_ = 0;
  }

  void watch() {
    while (!leave) {
      if (sem_wait(&wake) != 0) continue;
      if (const int signal = fatal) end_at_once(signal);
      for (std::size_t i = 0; i < watched.size(); ++i) {
        for (; seen_[i] < noted[i]; ++seen_[i]) respond_to(watched[i]);
      }
    }
  }

  void respond_to(int signal) {
    if (++count_ == 1) {
      if (writes_) fail_records(interrupted_unsaved(signal));
      say(fmt::format("{}: {}", signal_name(signal),
                      guards > 0 ? "the run saves its state and ends"
                                 : "the run will end after what it is at, which cannot be interrupted; a "
                                   "third Ctrl-C or kill ends it at once"));
    } else if (is_advance_notice(signal) || ++repetitions_ == 1) {
      say(fmt::format("{}: the run is saving its state; a third Ctrl-C or kill ends it at once",
                      signal_name(signal)));
    } else {
      end_at_once(signal);
    }
  }

  [[noreturn]] void end_at_once(int signal) {
    if (writes_) {
      fail_records(interrupted_by(signal));
      output::end_temporaries(folder_);
    }
    say(interrupted_by(signal));
    _exit(128 + signal);
  }

  void say(const std::string& text) const {
    if (writes_) print_error(fmt::format("rhexis: {}\n", text));
  }

  std::mutex mutex_;
  int runs_ = 0;
  std::vector<output::RunRecord*> records_;
  std::filesystem::path folder_;
  bool writes_ = false;
  std::array<struct sigaction, watched.size()> before_{};
  std::thread thread_;
  std::array<int, watched.size()> seen_{};
  int count_ = 0, repetitions_ = 0;
};

}  // namespace

void note_ignored_hangup() {
  struct sigaction hangup = {};
  sigaction(SIGHUP, nullptr, &hangup);
  hangup_was_ignored = hangup.sa_handler == SIG_IGN;
}

void prepare_signals() {
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  for (const int signal : {SIGPIPE, SIGXFSZ}) sigaction(signal, &ignore, nullptr);
}

std::string signal_name(int signal) {
  const std::size_t place = place_of(signal);
  return place < names.size() ? names[place] : fmt::format("signal {}", signal);
}

std::string interrupted_by(int signal) {
  return "interrupted by " + signal_name(signal);
}

SignalWatch::SignalWatch(const std::filesystem::path& folder, bool writes, bool embedded) {
  Watch::instance().start(folder, writes, embedded);
}

void SignalWatch::tell(output::RunRecord& record) {
  record_ = &record;
  Watch::instance().add(record);
}

SignalWatch::~SignalWatch() {
  Watch::instance().stop(record_);
}

InterruptGuard::InterruptGuard() {
  Watch::instance().catch_signals();
  ++guards;
}

InterruptGuard::~InterruptGuard() {
  --guards;
}

int InterruptGuard::requested() {
  return first_signal;
}

void fail_records_alone(const std::string& reason) noexcept {
  Watch::instance().fail_records(reason);
}

}  // namespace rhexis::runtime
