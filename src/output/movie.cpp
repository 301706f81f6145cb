// SPDX-License-Identifier: BSD-3-Clause
#include "output/movie.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "output/numbered_picture.hpp"

extern char** environ;

namespace rhexis::output {
namespace {

/// Other programs get signals as they expect them, not as this one has set them.
struct DefaultSignals {
  DefaultSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGPIPE, SIGXFSZ}) sigaddset(&signals, signal);
    posix_spawnattr_init(&value);
    posix_spawnattr_setsigdefault(&value, &signals);
    posix_spawnattr_setflags(&value, POSIX_SPAWN_SETSIGDEF);
  }
  ~DefaultSignals() { posix_spawnattr_destroy(&value); }
  DefaultSignals(const DefaultSignals&) = delete;
  DefaultSignals& operator=(const DefaultSignals&) = delete;
  posix_spawnattr_t value;
};

/// Exit status of a program found in PATH; -1 where it cannot be started.
int run_program(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const DefaultSignals attributes;
  pid_t child = 0;
  if (posix_spawnp(&child, argv[0], nullptr, &attributes.value, argv.data(), environ) != 0) return -1;
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

/// As a pattern that means just this path.
std::string literally(const std::string& path) {
  std::string pattern;
  for (const char c : path) {
    if (std::string_view("[]*?{}\\").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

}  // namespace

std::string make_movie(const std::filesystem::path& images, const std::vector<std::string>& names,
                       const std::filesystem::path& movie, double frames_per_second) {
  struct Series {
    int pictures = 0;
    std::set<std::size_t> digits = {};
  };
  std::map<std::string, Series> all;
  for (const std::filesystem::path picture : names) {
    const std::string name = picture_series(picture);
    if (name.empty() || picture.has_parent_path()) continue;
    ++all[name].pictures;
    all[name].digits.insert(picture.stem().string().size() - name.size() - 1);
  }
  const auto longest = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.second.pictures < b.second.pictures;
  });
  if (longest == all.end()) return "there are no numbered pictures";
  const auto& [name, series] = *longest;
  if (series.pictures < 2) return "there is one picture only";
  std::vector<std::string> command{"ffmpeg", "-nostdin", "-y", "-loglevel", "error"};
  // From the root: a path that begins with a dash would be an option, and one with a colon a protocol.
  const std::filesystem::path pictures = std::filesystem::absolute(images / name);
  for (const std::size_t digits : series.digits) {  // ffmpeg sorts names as text
    const std::string pattern = literally(pictures.string()) + '_' + std::string(digits, '?') + ".png";
    command.insert(command.end(), {"-framerate", fmt::format("{}", frames_per_second), "-pattern_type",
                                   "glob", "-i", pattern});
  }
  command.insert(
      command.end(),
      {"-filter_complex", fmt::format("concat=n={},pad=ceil(iw/2)*2:ceil(ih/2)*2", series.digits.size()),
       "-c:v", "libx264", "-preset", "veryfast", "-pix_fmt", "yuv420p", "-f", "mp4",
       std::filesystem::absolute(movie).string()});
  const int status = run_program(std::move(command));
  if (status == 127 || status == -1) return "ffmpeg could not be started; is it installed?";
  if (status != 0) return fmt::format("ffmpeg failed with status {}", status);
  return {};
}

}  // namespace rhexis::output
