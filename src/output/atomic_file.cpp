// SPDX-License-Identifier: BSD-3-Clause
#include "output/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.hpp"
#include "output/temporary_file.hpp"

namespace rhexis::output {
namespace {

/// False, with the reason in `errno`, where not all of it could be written.
bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

[[noreturn]] void fail(const std::filesystem::path& path, const char* doing, int reason) {
  throw RunError(fmt::format("{}: cannot {}: {}", path.string(), doing, std::strerror(reason)));
}

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view text) {
  TemporaryFile temporary(path);
  const int file = open(temporary.name().c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) fail(path, "write the file", errno);
  int reason = write_all(file, text) ? 0 : errno;
  if (close(file) != 0 && reason == 0) reason = errno;  // where a network's disk tells that it is full
  if (reason != 0) fail(path, "write the file", reason);
  temporary.put_in_place();
}

TableFile::TableFile(std::filesystem::path path, std::string_view text) : path_(std::move(path)) {
  write_atomically(path_, text);
  identity_.emplace(path_);
  descriptor_ = open(path_.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor_ < 0) fail(path_, "open the file", errno);
}

TableFile::TableFile(TableFile&& other) noexcept
    : path_(std::move(other.path_)),
      identity_(std::move(other.identity_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

TableFile& TableFile::operator=(TableFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(identity_, other.identity_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

TableFile::~TableFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void TableFile::append(std::string_view rows) {
  identity_->require_unchanged();
  const off_t before = lseek(descriptor_, 0, SEEK_END);
  if (write_all(descriptor_, rows)) return;
  const int reason = errno;
  if (before >= 0 && ftruncate(descriptor_, before) != 0) {  // then readers meet a row without an end
  }
  fail(path_, "add a row", reason);
}

}  // namespace rhexis::output
