/// What the command line says of a run, and how runs end.
#pragma once

#include <filesystem>

namespace rhexis::app {

struct RunOptions {
  std::filesystem::path directory;
  std::filesystem::path restart;  ///< checkpoint; empty: from the start
  bool quiet = false;
  double started = 0;  ///< s, of the clock
};

enum class Ending { completed, interrupted };

}  // namespace rhexis::app
