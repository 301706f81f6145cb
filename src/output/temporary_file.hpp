// SPDX-License-Identifier: BSD-3-Clause
/// Files under names that nobody can foresee, beside the file that they will become.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace rhexis::output {

/// 16 hexadecimal digits from the system's source of randomness, drawn once by each process. They are in the
/// name of every temporary file, so that a later run knows what a killed one left behind.
const std::string& run_token();

/// Gives this process the token of another rank. Not while other threads make temporary files.
void share_run_token(const std::string& token);

/// A name beside `path` for a temporary file, .NAME.TOKEN-NUMBER; another one at every call. No file
/// is made. The name is never longer than file systems allow (255 bytes) where that of `path` is not.
std::filesystem::path temporary_name_beside(const std::filesystem::path& path);

/// Whether a file of this name is a temporary one of the run that had this token.
bool is_temporary(std::string_view name, std::string_view token);

/// Removes the temporary files and folders of this process from `folder` and the folders in it, for a program
/// that ends at once. Does not throw.
void remove_temporaries(const std::filesystem::path& folder) noexcept;

/// The same for a program that is about to end while other threads write: whoever makes another waits for
/// ever.
void end_temporaries(const std::filesystem::path& folder) noexcept;

/// Makes a new, empty file in the folder of `path` and returns its name. What is there already is never
/// opened, and links are not followed (O_EXCL). Throws RunError that names `path` and the reason.
std::filesystem::path temporary_beside(const std::filesystem::path& path);

/// A temporary file that becomes the file `path`, or goes with its owner. Local to the calling rank.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path path);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& name() const { return temporary_; }

  /// Gives it the name `path`, in place of what had that name: a link is replaced, not followed. Throws
  /// RunError that names `path`.
  void put_in_place();

 private:
  std::filesystem::path path_, temporary_;
  bool in_place_ = false;
};

}  // namespace rhexis::output
