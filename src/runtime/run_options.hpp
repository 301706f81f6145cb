// SPDX-License-Identifier: BSD-3-Clause
/// What the command line says of a run, and how runs end.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output/results_folder.hpp"

namespace rhexis::runtime {

struct Pictures;

struct RunOptions {
  std::filesystem::path directory;
  std::filesystem::path restart;  ///< checkpoint; empty: from the start
  bool overwrite = false;         ///< files in the folder of results that no run made
  bool quiet = false;
  std::vector<std::string> command = {};    ///< as it was called
  double started = 0;                       ///< s, of the clock
  std::shared_ptr<Pictures> pictures = {};  ///< of the runs that this one is one of; null: it has its own
  std::optional<output::ResultsFolder> folder = {};  ///< that has been taken for it; none: the run takes it
};

/// By itself, or by a signal.
struct Ending {
  int signal = 0;  ///< 0: by itself

  bool interrupted() const { return signal != 0; }
};

}  // namespace rhexis::runtime
