// SPDX-License-Identifier: BSD-3-Clause
/// What the caller (command line or Python) says of a run beside its input, and how runs end.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "insitu/pipeline.hpp"
#include "output/results_folder.hpp"

namespace rhexis::runtime {

struct Pictures;

/// Is shown what a run has at each of its outputs, on all ranks. A RunError that it throws on all ranks ends
/// the run.
using OutputFunction = std::function<void(const insitu::Channels&)>;

struct RunOptions {
  std::filesystem::path directory;
  std::filesystem::path restart;  ///< checkpoint; empty: from the start
  bool overwrite = false;         ///< files in the folder of results that no run made
  bool quiet = false;
  bool embedded = false;          ///< in another program (Python), which goes on when the run has ended
  OutputFunction on_output = {};  ///< may be empty
  std::vector<std::string> command = {};    ///< as it was called
  double started = 0;                       ///< s, of the clock
  std::shared_ptr<Pictures> pictures = {};  ///< shared by the runs of a cascade or an ensemble; null: the run has its own
  std::optional<output::ResultsFolder> folder = {};  ///< that has been taken for it; none: the run takes it
};

/// By itself, or by a signal.
struct Ending {
  int signal = 0;  ///< 0: by itself

  bool interrupted() const { return signal != 0; }
};

}  // namespace rhexis::runtime
