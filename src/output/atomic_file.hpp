// SPDX-License-Identifier: BSD-3-Clause
/// Small text files that are never seen half written, and tables that grow by whole rows.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "output/file_identity.hpp"

namespace rhexis::output {

/// Replaces the file `path` by `text` in one step (a temporary file beside it, then a rename): a reader, or
/// what a crash leaves behind, has the old text or the new, never a part. Throws RunError that names the file
/// and the reason; the old file then stays. Local to the calling rank.
void write_atomically(const std::filesystem::path& path, std::string_view text);

/// A text file to which rows are added at its end, each handed to the system at once. Local to the calling
/// rank. Throws RunError that names the file and the reason (disk full, or somebody has taken the file away).
class TableFile {
 public:
  TableFile() = default;  ///< no file
  /// Replaces the file `path` by `text`, as write_atomically does.
  TableFile(std::filesystem::path path, std::string_view text);
  TableFile(TableFile&& other) noexcept;
  TableFile& operator=(TableFile&& other) noexcept;
  ~TableFile();

  /// Adds `rows`, whole lines. What the disk has no room for leaves no part of a row behind.
  void append(std::string_view rows);

 private:
  std::filesystem::path path_;
  std::optional<FileIdentity> identity_;
  int descriptor_ = -1;
};

}  // namespace rhexis::output
