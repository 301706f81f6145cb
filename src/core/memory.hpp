// SPDX-License-Identifier: BSD-3-Clause
/// How much memory this process may still take.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <optional>
#include <sstream>
#include <string>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis {

/// Bytes that are free, and what says so.
struct MemoryLimit {
  double bytes = std::numeric_limits<double>::infinity();
  std::string source;      ///< "MemAvailable", "memory.max of /user.slice", "ulimit -v"
  bool of_machine = true;  ///< shared by all processes of the machine, or this one's alone
};

/// The number after `name` in a file such as /proc/meminfo; none where it is not there.
inline std::optional<double> number_after(const std::string& name, const std::filesystem::path& file) {
  std::ifstream in(file);
  double number = 0;
  for (std::string word; in >> word;)
    if (word == name && in >> number) return number;
  return {};
}

/// The number that is all of a file; none for "max" and where there is no such file.
inline std::optional<double> number_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  double number = 0;
  if (in >> number) return number;
  return {};
}

/// What the control groups of this process and those above it leave, by version 2 or 1 of them; files that
/// are only cached count as free. `root`: of the file system, another one in tests.
inline MemoryLimit memory_of_control_groups(const std::filesystem::path& root = "/") {
  MemoryLimit least;
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    // "0::/user.slice" of version 2, "4:memory:/user.slice" of version 1.
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool version_2 = controllers.empty();
    if (!version_2 && ("," + controllers + ",").find(",memory,") == std::string::npos) continue;
    const std::filesystem::path mount = root / (version_2 ? "sys/fs/cgroup" : "sys/fs/cgroup/memory");
    for (std::filesystem::path group = line.substr(second + 1);; group = group.parent_path()) {
      const std::filesystem::path folder = mount / group.relative_path();
      const auto limit = number_in(folder / (version_2 ? "memory.max" : "memory.limit_in_bytes"));
      const auto used = number_in(folder / (version_2 ? "memory.current" : "memory.usage_in_bytes"));
      if (limit && used) {
        const double cached =
            number_after(version_2 ? "inactive_file" : "total_inactive_file", folder / "memory.stat")
                .value_or(0);
        const double left = std::max(0.0, *limit - std::max(0.0, *used - cached));
        if (left < least.bytes)
          least = {left, "the memory limit of the control group " + group.string(), true};
      }
      if (!group.has_relative_path()) break;
    }
  }
  return least;
}

/// The least of what the machine has, what the control groups leave and what limits of this process (ulimit
/// -v, -d) leave. Memory that other processes will take is not known here.
inline MemoryLimit available_memory() {
  MemoryLimit least = memory_of_control_groups();
  const auto consider = [&](double bytes, const char* source, bool of_machine) {
    if (bytes < least.bytes) least = {std::max(0.0, bytes), source, of_machine};
  };
  if (const auto kibibytes = number_after("MemAvailable:", "/proc/meminfo"))
    consider(1024 * *kibibytes, "MemAvailable of this machine", true);
  const auto consider_limit = [&](auto resource, const char* used, const char* source) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    consider(static_cast<double>(limit.rlim_cur) - 1024 * number_after(used, "/proc/self/status").value_or(0),
             source, false);
  };
  consider_limit(RLIMIT_AS, "VmSize:", "ulimit -v");
  consider_limit(RLIMIT_DATA, "VmData:", "ulimit -d");
  return least;
}

/// Runs `action`; throws InputError of `key` where memory runs out, with `what` needs more.
template <class Action>
void within_memory(const std::string& what, const std::string& key, const Action& action) {
  try {
    action();
  } catch (const std::bad_alloc&) {
    const MemoryLimit left = available_memory();
    throw InputError(what + " needs more memory than there is (" + quantity(left.bytes, "B") +
                         " is left by " + left.source + ")",
                     key);
  }
}

}  // namespace rhexis
