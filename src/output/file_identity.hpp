// SPDX-License-Identifier: BSD-3-Clause
/// Whether a name still means the file that it did.
#pragma once

#include <sys/types.h>

#include <filesystem>

namespace rhexis::output {

/// Remembers a file or a folder by its inode, so that its removal, or another in its place, is noticed: what
/// is written to a file without a name is lost, and what is in its place is somebody else's.
class FileIdentity {
 public:
  /// What `path` means now. Throws RunError where that is nothing.
  explicit FileIdentity(std::filesystem::path path);

  /// Throws RunError that names the path if it means nothing any more, or something else.
  void require_unchanged() const;

 private:
  std::filesystem::path path_;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

}  // namespace rhexis::output
