/// What the command line says of a run, and how runs end.
#pragma once

#include <filesystem>
#include <memory>

namespace rhexis::app {

struct Pictures;

struct RunOptions {
  std::filesystem::path directory;
  std::filesystem::path restart;  ///< checkpoint; empty: from the start
  bool quiet = false;
  double started = 0;                       ///< s, of the clock
  std::shared_ptr<Pictures> pictures = {};  ///< of the runs that this one is one of; null: it has its own
};

enum class Ending { completed, interrupted };

}  // namespace rhexis::app
