// SPDX-License-Identifier: BSD-3-Clause
/// What is in a results folder before a run changes anything there, and what of it would be in the run's way.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "output/manifest.hpp"
#include "output/results_folder.hpp"

namespace rhexis::output {

/// Throws InputError: results cannot be written there, why, and what can be done.
[[noreturn]] void refuse_results(const std::filesystem::path& path, const std::string& reason,
                                 const std::string& remedy = "choose another folder with -o");

/// Whether there is a folder of this name. Throws InputError where something else has it.
bool is_folder(const std::filesystem::path& path);

/// Names of what is in a folder; none where it is not there.
std::vector<std::string> entries_of(const std::filesystem::path& folder);

/// Local to the calling rank. Names are relative to the folder.
class FolderContents {
 public:
  /// Reads the manifest. Throws InputError as refuse_obstacles (results_folder.hpp).
  explicit FolderContents(const FolderPlan& plan);

  /// Throws InputError if one of these files cannot be written.
  void refuse_obstacles(const FutureFiles& files) const;
  void refuse_obstacles(const std::vector<std::string>& names) const;

  /// Whether the run reads this file, whatever its name.
  bool is_read(const std::filesystem::path& path) const;
  /// Whether all folders on the way to this file are folders, not links, as far as they are there.
  bool is_straight(const std::string& name) const { return detour(name).empty(); }

  Manifest manifest;

 private:
  using Identity = std::pair<dev_t, ino_t>;

  static std::set<Identity> identities(const std::vector<std::filesystem::path>& paths);
  bool is_ours(const std::string& name) const;
  /// The first part of the way to a file that is no folder.
  std::filesystem::path detour(const std::string& name) const;
  void refuse_detour(const std::string& name) const;

  std::filesystem::path directory_;
  bool overwrite_;
  std::set<Identity> reads_;
};

/// Those that are always there.
inline constexpr const char* standing_folders[] = {"images", "checkpoints"};

}  // namespace rhexis::output
