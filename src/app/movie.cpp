#include "app/movie.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <vector>

#include "output/numbered_picture.hpp"

extern char** environ;

namespace rhexis::app {
namespace {

/// Exit status of a program found in PATH; -1 where it cannot be started.
int run_program(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawnp(&child, argv[0], nullptr, nullptr, argv.data(), environ) != 0) return -1;
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

std::string make_movie(const std::filesystem::path& images, const std::filesystem::path& movie,
                       double frames_per_second) {
  std::map<std::string, int> series;
  for (const auto& entry : std::filesystem::directory_iterator(images)) {
    const std::string name = output::picture_series(entry.path());
    if (!name.empty()) ++series[name];
  }
  const auto longest = std::max_element(series.begin(), series.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  if (longest == series.end()) return "there are no numbered pictures";
  if (longest->second < 2) return "there is one picture only";
  const int status = run_program(
      {"ffmpeg", "-nostdin", "-y", "-loglevel", "error", "-framerate", fmt::format("{}", frames_per_second),
       "-pattern_type", "glob", "-i", literally((images / longest->first).string()) + "_*.png", "-c:v",
       "libx264", "-preset", "veryfast", "-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", movie.string()});
  if (status == 127 || status == -1) return "ffmpeg could not be started; is it installed?";
  if (status != 0) return fmt::format("ffmpeg failed with status {}", status);
  return {};
}

}  // namespace rhexis::app
