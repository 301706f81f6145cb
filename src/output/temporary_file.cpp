// SPDX-License-Identifier: BSD-3-Clause
#include "output/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace rhexis::output {
namespace {

std::string& token() {
  static std::string drawn = [] {
    std::uint64_t digits = 0;
    if (getentropy(&digits, sizeof digits) != 0)
      throw RunError(fmt::format("the system gives no random numbers: {}", std::strerror(errno)));
    return fmt::format("{:016x}", digits);
  }();
  return drawn;
}

/// Held while a temporary file is made, and for ever once there shall be no more.
std::mutex& making() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

const std::string& run_token() {
  return token();
}

void share_run_token(const std::string& shared) {
  token() = shared;
}

std::filesystem::path temporary_name_beside(const std::filesystem::path& path) {
  static std::atomic<std::uint64_t> made{0};
  const std::string ending = fmt::format(".{}-{}", run_token(), made++);
  const std::string name = path.filename().string().substr(0, NAME_MAX - 1 - ending.size());
  return path.parent_path() / fmt::format(".{}{}", name, ending);
}

bool is_temporary(std::string_view name, std::string_view token) {
  const std::size_t number = name.find_last_not_of("0123456789");
  if (!name.starts_with('.') || number == std::string_view::npos || number + 1 == name.size()) return false;
  return name.substr(0, number + 1).ends_with(fmt::format(".{}-", token));
}

void remove_temporaries(const std::filesystem::path& folder) noexcept {
  namespace fs = std::filesystem;
  try {
    std::vector<fs::path> ours;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
      if (is_temporary(entry.path().filename().string(), run_token())) ours.push_back(entry.path());
    for (const fs::path& path : ours) fs::remove_all(path);
  } catch (const std::exception&) {  // what is left the next run removes
  }
}

void end_temporaries(const std::filesystem::path& folder) noexcept {
  making().lock();
  remove_temporaries(folder);
  // HDF5 may have been about to open by name one that was made before.
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  remove_temporaries(folder);
}

std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  const std::lock_guard lock(making());
  for (;;) {
    std::filesystem::path name = temporary_name_beside(path);
    const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) {
      close(file);
      return name;
    }
    if (errno != EEXIST)
      throw RunError(fmt::format("{}: cannot create the file: {}", path.string(), std::strerror(errno)));
  }
}

TemporaryFile::TemporaryFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(temporary_beside(path_)) {}

TemporaryFile::~TemporaryFile() {
  if (!in_place_) unlink(temporary_.c_str());
}

void TemporaryFile::put_in_place() {
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0)
    throw RunError(fmt::format("{}: cannot write the file: {}", path_.string(), std::strerror(errno)));
  in_place_ = true;
}

}  // namespace rhexis::output
