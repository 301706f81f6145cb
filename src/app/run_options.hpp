/// What the command line says of a run, and how runs end.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace rhexis::app {

struct Pictures;

struct RunOptions {
  std::filesystem::path directory;
  std::filesystem::path restart;  ///< checkpoint; empty: from the start
  bool quiet = false;
  std::vector<std::string> command = {};    ///< as it was called
  double started = 0;                       ///< s, of the clock
  std::shared_ptr<Pictures> pictures = {};  ///< of the runs that this one is one of; null: it has its own
};

enum class Ending { completed, interrupted };

}  // namespace rhexis::app
