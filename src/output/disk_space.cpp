#include "output/disk_space.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/error.hpp"

namespace rhexis::output {
namespace {

struct OpenFile {
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor(open(path.c_str(), O_WRONLY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (descriptor >= 0) close(descriptor);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int descriptor;
};

}  // namespace

void reserve_space(const std::filesystem::path& path, std::span<const ByteRange> ranges) {
  const OpenFile file(path);
  bool reserved = file.descriptor >= 0;
  for (std::size_t i = 0; reserved && i < ranges.size(); ++i) {
    reserved = ranges[i].count == 0 || fallocate(file.descriptor, 0, ranges[i].offset, ranges[i].count) == 0;
  }
  if (reserved || errno == EOPNOTSUPP) return;

  const std::string reason = std::strerror(errno);
  for (const ByteRange& range : ranges) {
    fallocate(file.descriptor, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, range.offset, range.count);
  }
  throw RunError(fmt::format("{}: cannot reserve disk space: {}", path.string(), reason));
}

}  // namespace rhexis::output
