// SPDX-License-Identifier: BSD-3-Clause
/// An end for scripts that do not end by themselves.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace rhexis::insitu {

/// Watches, from a thread of its own, how long a script has been at work. Past the limit it raises
/// rhexis_catalyst.TimeIsUp in the script's Python code; where that does not end it within `grace_s` (it
/// waits inside a library), it has the program ended.
class TimeLimit {
 public:
  /// Made on the thread that runs scripts. `end_program` is called, on the thread that watches, with the
  /// reason.
  TimeLimit(double limit_s, double grace_s, std::function<void(const std::string&)> end_program);
  ~TimeLimit();
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

  /// From now on the script `path` is at work, until `end`.
  void begin(const std::string& path);
  void end();

  /// E.g. "600 s".
  std::string limit() const;

  /// While this lives, the script does not count as at work: its rank waits for the others.
  class Pause {
   public:
    explicit Pause(TimeLimit& limit);
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    TimeLimit& limit_;
    bool was_at_work_;
  };

 private:
  using Clock = std::chrono::steady_clock;
  void watch();
  void interrupt();

  /// What threads share; an interrupting thread may outlive the script that it was made for.
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
    std::string path;
    Clock::time_point began;
    bool at_work = false;
    bool interrupting = false;  ///< a thread waits for the interpreter
    bool over = false;
  };

  const double limit_s_, grace_s_;
  const unsigned long python_thread_;
  const std::function<void(const std::string&)> end_program_;
  const std::shared_ptr<State> state_ = std::make_shared<State>();
  std::thread thread_;
};

}  // namespace rhexis::insitu
