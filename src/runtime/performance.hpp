// SPDX-License-Identifier: BSD-3-Clause
/// What a run took: the `performance` part of run.json.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace rhexis::runtime {

/// The `performance` part; a member without a value is written as null.
struct Performance {
  std::optional<std::string> processor = {};  ///< the processor of the first rank
  std::optional<std::string> compiler = {};   ///< with version, kind of build and vectors
  std::optional<std::int64_t> ranks = {}, threads = {};
  std::optional<double> wall_s = {};
  std::optional<double> solve_s = {};  ///< the time loop less output and in situ
  std::optional<double> insitu_s = {}, output_s = {};
  std::optional<std::int64_t> bond_evaluations = {};  ///< directed
  std::optional<double> bond_evaluations_per_s = {};
  /// Needed by the bonds and by the vessels of trees that are not stored; that of graphs is not counted.
  std::optional<double> flop = {};
  std::optional<double> exchange_s = {};            ///< the halo exchange, waiting included, mean over ranks
  std::optional<std::int64_t> exchange_bytes = {};  ///< sent to other ranks, sum over all
  /// Time and rate of one message between the first rank and the last (parallel::measure_link).
  std::optional<double> message_latency_s = {}, message_bandwidth_B_s = {};
  std::optional<std::int64_t> peak_rss_bytes = {};  ///< sum over all ranks
  std::optional<double> node_hours = {};
  std::optional<double> energy_J =
      {};  ///< taken by all nodes' processors, whoever used them; none where they do not tell
};

void to_json(nlohmann::ordered_json& json, const Performance& performance);

}  // namespace rhexis::runtime
