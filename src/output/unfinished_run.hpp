// SPDX-License-Identifier: BSD-3-Clause
/// A run whose record says 'running': at work, or ended without a word.
#pragma once

#include <filesystem>
#include <optional>

namespace rhexis::output {

struct UnfinishedRun {
  enum class State { at_work, dead, unknown };  ///< unknown: on file systems without locks
  State state = State::unknown;
  std::filesystem::path last_checkpoint;  ///< empty where there is none
  bool holds_samples = false;  ///< the run was an ensemble: there is nothing to restart from, nor a need to
};

/// Looks for a run that wrote to `folder` last and has not told its end; nothing where there is none. Local
/// to the calling rank. Does not throw but for want of memory.
std::optional<UnfinishedRun> unfinished_run(const std::filesystem::path& folder);

}  // namespace rhexis::output
