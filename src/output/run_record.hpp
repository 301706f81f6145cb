/// run.json: what was run, how it ended, what came out and what it cost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "output/disk_space.hpp"
#include "output/file_identity.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

/// The `results.network` part; a member without a value is written as null.
struct NetworkResults {
  std::optional<std::int64_t> vessels = {}, junctions = {};
  std::optional<double> inflow_m3_s = {};
  std::optional<double> max_imbalance = {};               ///< relative to the inflow
  std::optional<double> volume_m3 = {}, surface_m2 = {};  ///< of the lumens
  std::optional<double> highest_reynolds = {};            ///< number
  std::optional<double> highest_pressure_Pa = {}, lowest_pressure_Pa = {};
  std::optional<std::string> solver = {};
  std::optional<std::int64_t> iterations = {};
  nlohmann::ordered_json queries = nullptr;    ///< a list of the vessels that the user asked for
  nlohmann::ordered_json screening = nullptr;  ///< how many vessels are above their limit, and a list
};

/// The `results` part; a member without a value is written as null.
struct Results {
  std::optional<std::int64_t> particles = {};
  std::optional<std::int64_t> bonds = {};  ///< undirected
  std::optional<std::int64_t> family_max = {};
  std::optional<double> time_step_s = {}, stable_time_step_s = {};
  std::optional<std::int64_t> steps = {};
  std::optional<double> simulated_s = {};
  std::optional<double> first_bond_break_s = {};
  std::optional<double> rupture_onset_s = {};       ///< first time that some particle's damage >= 0.2
  std::optional<double> pressure_at_onset_Pa = {};  ///< the largest in the vessel, on the reference area
  /// The blood pressure that pushes the stretched lumen as hard: the one above over the lumen's stretch.
  std::optional<double> blood_pressure_at_onset_Pa = {};
  std::optional<double> max_displacement_at_onset_m = {};
  std::optional<double> max_displacement_m = {}, max_damage = {};
  std::optional<double> rupture_length_m = {};  ///< axial extent of damage >= 0.2
  std::optional<double> opening_area_m2 = {};   ///< of the holes in the wall, at the end
  std::optional<double> energy_drift = {};
  NetworkResults network = {};
  nlohmann::ordered_json coupling = nullptr;  ///< the vessel's place in the network, and what they exchanged
  nlohmann::ordered_json cascade = nullptr;   ///< its events
  nlohmann::ordered_json ensemble = nullptr;  ///< pressures, samples and their cost
};

/// The `performance` part; a member without a value is written as null.
struct Performance {
  std::optional<std::string> processor = {};  ///< of the first rank
  std::optional<std::string> compiler = {};   ///< with version, kind of build and vectors
  std::optional<std::int64_t> ranks = {}, threads = {};
  std::optional<double> wall_s = {};
  std::optional<double> solve_s = {};  ///< the time loop less output and in situ
  std::optional<double> insitu_s = {}, output_s = {};
  std::optional<std::int64_t> bond_evaluations = {};  ///< directed
  std::optional<double> bond_evaluations_per_s = {};
  /// Needed by the bonds and by the vessels of trees that are not stored; that of graphs is not counted.
  std::optional<double> flop = {};
  std::optional<double> exchange_s = {};            ///< of halos, waiting included, mean over ranks
  std::optional<std::int64_t> exchange_bytes = {};  ///< sent to other ranks, sum over all
  /// Of one message between the first rank and the last (parallel::measure_link).
  std::optional<double> message_latency_s = {}, message_bandwidth_B_s = {};
  std::optional<std::int64_t> peak_rss_bytes = {};  ///< sum over all ranks
  std::optional<double> node_hours = {};
  std::optional<double> energy_J = {};  ///< of all nodes' processors, whoever used them; where they tell
};

void to_json(nlohmann::ordered_json& json, const NetworkResults& network);
void to_json(nlohmann::ordered_json& json, const Results& results);
void to_json(nlohmann::ordered_json& json, const Performance& performance);

/// Where the numbers come from: program, call and input.
struct Provenance {
  std::string version = {}, commit = {};
  std::vector<std::string> command = {};        ///< as it was called
  std::string file = {};                        ///< of input
  std::string started = {};                     ///< 2026-11-29T00:18:13Z
  std::optional<std::string> checkpoint = {};   ///< that the run goes on from
  std::optional<std::int64_t> first_step = {};  ///< of that checkpoint
  nlohmann::ordered_json input = nullptr;       ///< the whole configuration as resolved
};

/// The status of a run that has not told its end.
inline constexpr const char* running_status = "running";
/// What the file run.json says of its run; empty where there is no such file, or it is damaged. Local to the
/// calling rank.
std::string recorded_status(const std::filesystem::path& path);

/// The file, from the first moment of a run to its last. Collective; only the root writes, in one step each
/// time, so the file can be read at any moment. All writing throws RunError on all ranks when it cannot be
/// done.
class RunRecord {
 public:
  /// Writes the file with status "running".
  RunRecord(std::filesystem::path path, const Provenance& provenance, parallel::Communicator communicator);

  /// Something that the user was told; is written with what comes next.
  void warn(const std::string& text);
  /// The results so far, for a run that ends before it can say more; written with what comes next.
  void know(const Results& results);

  void complete(const Results& results, const Performance& performance);

  /// Status "failed: `reason`", with what is known so far.
  void fail(const std::string& reason, const Results& results, const Performance& performance);

  /// Status "failed: `reason`", by one rank and any of its threads: for a program that may end before it can
  /// say more. Changes nothing once the run has ended, or where another rank has told why. Does not throw.
  void fail_alone(const std::string& reason) noexcept;

 private:
  void write(const std::string& status);
  void end(const std::string& status, const Results& results, const Performance& performance);

  std::mutex mutex_;  ///< of all below
  std::filesystem::path path_;
  nlohmann::ordered_json document_;
  parallel::Communicator communicator_;
  std::optional<FileIdentity> folder_;  ///< of the first rank
  bool ended_ = false;
  std::unique_ptr<SpareSpace> spare_;  ///< of the first rank: for the last words, should the disk be full
};

}  // namespace rhexis::output
