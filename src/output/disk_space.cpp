// SPDX-License-Identifier: BSD-3-Clause
#include "output/disk_space.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/error.hpp"
#include "output/temporary_file.hpp"

namespace rhexis::output {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* doing, int error) {
  throw RunError(fmt::format("{}: cannot {}: {}", path.string(), doing, std::strerror(error)));
}

}  // namespace

FileInPlace::FileInPlace(const std::filesystem::path& path)
    : path_(path), descriptor_(open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW)) {
  if (descriptor_ < 0) fail(path_, "open the file", errno);
}

FileInPlace::~FileInPlace() {
  ::close(descriptor_);
}

void FileInPlace::write(std::int64_t offset, std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), offset);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(path_, "write the file", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += written;
  }
}

void FileInPlace::sync() const {
  if (fsync(descriptor_) != 0) fail(path_, "write the file", errno);
}

void reserve_space(const std::filesystem::path& path, std::span<const ByteRange> ranges) {
  const FileInPlace file(path);
  int error = 0;
  for (std::size_t i = 0; error == 0 && i < ranges.size(); ++i) {
    if (ranges[i].count > 0) error = posix_fallocate(file.descriptor(), ranges[i].offset, ranges[i].count);
  }
  if (error == 0) return;
  for (const ByteRange& range : ranges) {
    fallocate(file.descriptor(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, range.offset, range.count);
  }
  fail(path, "reserve disk space", error);
}

SpareSpace::SpareSpace(const std::filesystem::path& beside, std::int64_t bytes) {
  {
    // Without a name, the space is free again as soon as it is closed, however the program ends.
    const TemporaryFile unnamed(beside);
    descriptor_ = open(unnamed.name().c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  }
  if (descriptor_ < 0) fail(beside, "create the file", errno);
  const int error = posix_fallocate(descriptor_, 0, bytes);
  if (error == 0) return;
  ::close(descriptor_);
  fail(beside, "reserve disk space", error);
}

SpareSpace::~SpareSpace() {
  ::close(descriptor_);
}

void sync_to_disk(const std::filesystem::path& path) {
  FileInPlace(path).sync();
}

}  // namespace rhexis::output
