// SPDX-License-Identifier: BSD-3-Clause
/// Measures where a run spends its time.
#pragma once

#include <chrono>

namespace rhexis {

/// The time of a clock that only goes forward, s.
inline double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Adds the time that passes while it lives to `total` (s).
class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total), start_(seconds_now()) {}
  ~Stopwatch() { total_ += seconds_now() - start_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& total_;
  double start_;
};

}  // namespace rhexis
