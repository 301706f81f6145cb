/// Ctrl-C, and SIGTERM, which mpirun and batch systems send.
#pragma once

#include <filesystem>
#include <string>

namespace rhexis::app {

/// Notes signals while it lives, for the next step to act on. A second one ends the program at once, as
/// without it.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static bool requested();
};

/// For work that cannot be stopped half way and has nothing to save: a signal leaves `text` in the file and
/// ends the program with status 130. One at a time.
class LastWords {
 public:
  LastWords(const std::filesystem::path& file, std::string text);
  ~LastWords();
  LastWords(const LastWords&) = delete;
  LastWords& operator=(const LastWords&) = delete;
};

}  // namespace rhexis::app
