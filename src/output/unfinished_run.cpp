// SPDX-License-Identifier: BSD-3-Clause
#include "output/unfinished_run.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string>

#include "output/run_record.hpp"

namespace rhexis::output {
namespace {

namespace fs = std::filesystem;

/// A run holds a lock of its folder as long as it lives (results_folder.hpp).
UnfinishedRun::State state_of(const fs::path& folder) {
  using State = UnfinishedRun::State;
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return State::unknown;
  const bool free = flock(file, LOCK_SH | LOCK_NB) == 0;
  const State state = free ? State::dead : errno == EWOULDBLOCK ? State::at_work : State::unknown;
  close(file);
  return state;
}

/// The step of a checkpoint's name, step_<digits>.h5; -1 of other names.
long step_of(const std::string& name) {
  constexpr std::string_view before = "step_", after = ".h5";
  if (!name.starts_with(before) || !name.ends_with(after)) return -1;
  const char* end = name.data() + name.size() - after.size();
  long step = -1;
  const auto [stop, error] = std::from_chars(name.data() + before.size(), end, step);
  return error == std::errc() && stop == end ? step : -1;
}

fs::path last_checkpoint(const fs::path& folder) {
  fs::path last;
  long last_step = -1;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "checkpoints", none)) {
    const long step = step_of(entry.path().filename());
    if (step <= last_step) continue;
    last_step = step;
    last = entry.path();
  }
  return last;
}

}  // namespace

std::optional<UnfinishedRun> unfinished_run(const fs::path& folder) {
  if (recorded_status(folder / "run.json") != running_status) return {};
  std::error_code ignored;
  return UnfinishedRun{.state = state_of(folder),
                       .last_checkpoint = last_checkpoint(folder),
                       .holds_samples = fs::exists(folder / "samples.csv", ignored)};
}

}  // namespace rhexis::output
