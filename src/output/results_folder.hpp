// SPDX-License-Identifier: BSD-3-Clause
/// The folder that a run writes to. A run replaces or removes there only what earlier runs made, as their
/// manifest tells, and never what it reads itself; it follows no links inside the folder.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "parallel/communicator.hpp"

namespace rhexis::output {

/// What becomes of the results that an earlier run left in the folder.
enum class EarlierResults {
  remove,  ///< so that results of two runs never mix
  keep     ///< a restart continues them
};

/// Files that a run will write, by their names relative to its folder.
struct FutureFiles {
  std::vector<std::string> names = {};
  /// Whether it may write this one too: asked of each file in `images/` and `checkpoints/`.
  std::function<bool(const std::string& name)> may_be_written = [](const std::string&) { return false; };
};

/// What a run will do to its folder.
struct FolderPlan {
  std::filesystem::path directory;
  EarlierResults earlier = EarlierResults::remove;
  /// Whether this file goes although earlier results are kept, unless it is a checkpoint.
  std::function<bool(const std::string& name)> drops = [](const std::string&) { return false; };
  bool overwrite = false;                         ///< files that no run made may be replaced
  std::vector<std::filesystem::path> reads = {};  ///< files, or folders of files, that are never touched
  FutureFiles writes = {};
};

/// Throws InputError on all ranks, naming the files and what can be done, if what the plan says cannot be
/// done: a file is in the way that no run made, a file that the run itself reads would be written, a link or
/// a file is where a folder must be, or the manifest is damaged. So is, where earlier results would be
/// removed, the folder of an ensemble by another run: samples took long. Nothing is changed. Collective.
void refuse_obstacles(const FolderPlan& plan, const parallel::Communicator& communicator);

/// A handle to the folder; copies share it. As long as one of them lives, the folder is this run's alone
/// (flock, on the root; where a file system knows no locks, nothing is held).
class ResultsFolder {
 public:
  /// Makes the folder with its parents, `images/` and `checkpoints/`, makes sure that it can be written to,
  /// and refuses obstacles and a folder where another run is still writing. What earlier runs left stays;
  /// folders that were made go with the object unless `remove_earlier_results` is called.
  /// Collective; throws InputError on all ranks if the folder cannot be used.
  ResultsFolder(const FolderPlan& plan, const parallel::Communicator& communicator);

  /// Tells of more files that the run will write; obstacles are refused as by the constructor. Collective.
  void will_write(const FutureFiles& files) const;

  /// Once all that can be checked beforehand has been: removes what runs that were killed left unfinished,
  /// and, where the plan says so, the files that the manifest names; checkpoints stay. Then begins the
  /// manifest of this run. Later calls do nothing. Collective; throws InputError or RunError if it cannot be
  /// done.
  void remove_earlier_results() const;

  /// Announces a file in the manifest, makes the folder that it is in, and returns its path. Names that were
  /// claimed before are let pass. Throws InputError if a file that no run made, or one that this run reads,
  /// is in the way, and RunError if the manifest cannot be written. Collective.
  std::filesystem::path claim(const std::string& name) const;
  /// The same by the root alone, which alone throws.
  std::filesystem::path claim_on_root(const std::string& name) const;

  /// Names, relative to `folder`, of the files in and below that folder which the manifest knows. Of the root
  /// alone.
  std::vector<std::string> files_in(const std::string& folder) const;

  /// A folder inside, made by what is claimed there, whose names are relative to it.
  ResultsFolder subfolder(const std::string& name) const;

  std::filesystem::path path() const;

 private:
  class State;
  ResultsFolder(std::shared_ptr<State> state, std::string prefix);

  std::shared_ptr<State> state_;
  std::string prefix_;  ///< begins every name: empty or with a slash at its end
};

}  // namespace rhexis::output
