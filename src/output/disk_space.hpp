/// Disk space that is had before it is needed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace rhexis::output {

/// A part of a file.
struct ByteRange {
  std::int64_t offset = 0, count = 0;
};

/// Has the file system reserve space for these parts of an existing file, whose content is not changed.
/// Throws RunError if the disk is full (then what was reserved here is given back: the space serves the last
/// words of the run) or the file cannot be written. Does nothing where the file system cannot reserve. Local
/// to the calling rank.
///
/// Why not wait for the write to fail: MPI libraries report a disk that fills up during a collective write on
/// some ranks, late, without the reason, or, when the last bytes only are missing, not at all.
void reserve_space(const std::filesystem::path& path, std::span<const ByteRange> ranges);

}  // namespace rhexis::output
