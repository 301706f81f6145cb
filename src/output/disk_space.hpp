// SPDX-License-Identifier: BSD-3-Clause
/// Files changed in place: disk space that is had before it is needed, and data that are known to be on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace rhexis::output {

/// A part of a file.
struct ByteRange {
  std::int64_t offset = 0, count = 0;
};

/// An existing file, open to be changed in place, at the end of no symbolic link. Every call throws RunError
/// that names the file and the reason. Local to the calling rank.
class FileInPlace {
 public:
  explicit FileInPlace(const std::filesystem::path& path);
  ~FileInPlace();
  FileInPlace(const FileInPlace&) = delete;
  FileInPlace& operator=(const FileInPlace&) = delete;

  void write(std::int64_t offset, std::string_view bytes) const;
  /// Waits until all that was written to the file is on disk.
  void sync() const;
  int descriptor() const { return descriptor_; }

 private:
  std::filesystem::path path_;
  int descriptor_;
};

/// Reserves disk space for these parts of an existing file; their content stays. Throws RunError if the disk
/// or a quota is full (what the parts held is then given back: a step that cannot be stored leaves its space
/// to the last words of the run) or if the file cannot be written. Local to the calling rank.
///
/// Why not wait for the write to fail: Open MPI's collective writes drop this error on three ranks and more,
/// and on fewer ranks report it without the reason.
void reserve_space(const std::filesystem::path& path, std::span<const ByteRange> ranges);

/// Space held on the disk of a file until the end of this object's life, then free for that file to grow
/// into. Throws RunError if there is not enough. Local to the calling rank.
class SpareSpace {
 public:
  SpareSpace(const std::filesystem::path& beside, std::int64_t bytes);
  ~SpareSpace();
  SpareSpace(const SpareSpace&) = delete;
  SpareSpace& operator=(const SpareSpace&) = delete;

 private:
  int descriptor_;
};

/// Waits until all that this process wrote to the file is on disk. Throws RunError if it cannot be. Local to
/// the calling rank, unlike HDF5's flush, which waits for ever if another rank cannot flush.
void sync_to_disk(const std::filesystem::path& path);

}  // namespace rhexis::output
