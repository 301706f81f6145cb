/// Ctrl-C (and SIGTERM, which mpirun and batch systems send): noted, and acted on at the next step.
#pragma once

namespace rhexis::app {

/// Catches signals while it lives. A second one ends the program at once, as without it.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static bool requested();
};

}  // namespace rhexis::app
