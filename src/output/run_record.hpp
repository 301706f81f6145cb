// SPDX-License-Identifier: BSD-3-Clause
/// run.json: what was run, how it ended, what came out and what it cost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "output/disk_space.hpp"
#include "output/file_identity.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

/// Where the numbers come from: program, call and input.
struct Provenance {
  std::string version = {}, commit = {};
  std::vector<std::string> command = {};        ///< as it was called
  std::string file = {};                        ///< path of the input file
  std::string started = {};                     ///< 2026-11-29T00:18:13Z
  std::optional<std::string> checkpoint = {};   ///< that the run goes on from
  std::optional<std::int64_t> first_step = {};  ///< time step of that checkpoint
};

/// The status of a run that has not told its end.
inline constexpr const char* running_status = "running";
/// What the file run.json says of its run; empty where there is no such file, or it is damaged. Local to the
/// calling rank.
std::string recorded_status(const std::filesystem::path& path);

/// Names and values, in the order of the file.
using Values = nlohmann::ordered_json;

/// The file, from the first moment of a run to its last. Collective; only the root writes, in one step each
/// time, so the file can be read at any moment. All writing throws RunError on all ranks when it cannot be
/// done.
class RunRecord {
 public:
  /// Writes the file with status "running". `input` is the whole configuration as resolved; `results` and
  /// `performance` are objects of names and values, of which those that are not known yet are null: readers
  /// find every name from the first moment on.
  RunRecord(std::filesystem::path path, const Provenance& provenance, const Values& input,
            const Values& results, const Values& performance, parallel::Communicator communicator);
  ~RunRecord();

  /// Something that the user was told; is written with what comes next.
  void warn(const std::string& text);
  /// The results so far, for a run that ends before it can say more; written with what comes next.
  void know(const Values& results);

  void complete(const Values& results, const Values& performance);

  /// Status "failed: `reason`", with what is known so far.
  void fail(const std::string& reason, const Values& results, const Values& performance);

  /// Status "failed: `reason`", by one rank and any of its threads: for a program that may end before it can
  /// say more. Changes nothing once the run has ended, or where another rank has told why. Does not throw.
  void fail_alone(const std::string& reason) noexcept;

 private:
  void write(const std::string& status);
  void end(const std::string& status, const Values& results, const Values& performance);

  std::mutex mutex_;  ///< guards all below
  std::filesystem::path path_;
  std::unique_ptr<Values> document_;
  parallel::Communicator communicator_;
  std::optional<FileIdentity> folder_;  ///< held by the first rank
  bool ended_ = false;
  std::unique_ptr<SpareSpace>
      spare_;  ///< held by the first rank: room for the last words, should the disk be full
};

}  // namespace rhexis::output
