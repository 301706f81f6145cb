// SPDX-License-Identifier: BSD-3-Clause
/// A folder for one test, the same on all ranks, removed after it.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "parallel/communicator.hpp"

namespace rhexis::test {

class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name;
    if (world_.is_root()) {
      name = (std::filesystem::temp_directory_path() / "rhexis-test-XXXXXX").string();
      if (mkdtemp(name.data()) == nullptr) name.clear();
    }
    path_ = world_.broadcast(name);
  }
  ~TemporaryDirectory() {
    world_.barrier();
    if (world_.is_root()) std::filesystem::remove_all(path_);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  parallel::Communicator world_ = parallel::Communicator::world();
  std::filesystem::path path_;
};

inline std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// Calls `action` and returns the message of the `Error` that it throws, "" if it throws none.
template <class Error, class Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace rhexis::test
