// SPDX-License-Identifier: BSD-3-Clause
/// Where somebody else writes files (Catalyst scripts their pictures), which become results when they are
/// complete.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "output/results_folder.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

/// A private folder inside one of the results folder's. Its files stay in it as long as it lives, so that who
/// wrote them can read them or add to them. All calls are collective.
class StagingFolder {
 public:
  /// `place`: the folder that the files end up in, relative to the results folder. Makes nothing.
  StagingFolder(ResultsFolder results, std::string place, const parallel::Communicator& communicator);
  ~StagingFolder();
  StagingFolder(const StagingFolder&) = delete;
  StagingFolder& operator=(const StagingFolder&) = delete;

  /// Absolute.
  const std::filesystem::path& path() const { return path_; }

  /// Makes the folder, and in it what the manifest knows of its place, for a run that goes on with results of
  /// an earlier one. After the results folder's own beginning; later calls do nothing. Throws RunError.
  void open();

  /// Makes results of the files that `author` has written or changed since the last call, in subfolders too,
  /// each in one step. Throws RunError, naming the file, where one of the user's is in the way or another
  /// author has written it at this step.
  void deliver(const std::string& author, long step);

 private:
  /// What shows that a file has changed.
  struct Version {
    std::int64_t inode = 0, size = 0, seconds = 0, nanoseconds = 0;
    auto operator<=>(const Version&) const = default;
  };
  struct Delivered {
    Version version;
    std::string author = "";
    long step = -1;
  };

  void deliver_file(const std::string& name, const std::string& author, long step);
  static Version version_of(const std::filesystem::path& file);

  ResultsFolder results_;
  std::string place_;
  parallel::Communicator communicator_;
  std::filesystem::path path_;
  bool open_ = false;
  std::map<std::string, Delivered> delivered_;  ///< by name relative to the folder; on the root
};

}  // namespace rhexis::output
