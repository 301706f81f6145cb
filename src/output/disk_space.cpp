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

struct OpenFile {
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor(open(path.c_str(), O_WRONLY | O_CLOEXEC)) {
    if (descriptor < 0) fail(path, "open the file", errno);
  }
  ~OpenFile() { close(descriptor); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int descriptor;
};

}  // namespace

void reserve_space(const std::filesystem::path& path, std::span<const ByteRange> ranges) {
  const OpenFile file(path);
  int error = 0;
  for (std::size_t i = 0; error == 0 && i < ranges.size(); ++i) {
    if (ranges[i].count > 0) error = posix_fallocate(file.descriptor, ranges[i].offset, ranges[i].count);
  }
  if (error == 0) return;
  for (const ByteRange& range : ranges) {
    fallocate(file.descriptor, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, range.offset, range.count);
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
  const OpenFile file(path);
  if (fsync(file.descriptor) != 0) fail(path, "write the file", errno);
}

}  // namespace rhexis::output
