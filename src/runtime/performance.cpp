// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/performance.hpp"

#include <nlohmann/json.hpp>

#include "output/json.hpp"

namespace rhexis::runtime {
namespace {

using output::or_null;
using Json = nlohmann::ordered_json;

}  // namespace

void to_json(Json& json, const Performance& performance) {
  json = Json::object({{"processor", or_null(performance.processor)},
                       {"compiler", or_null(performance.compiler)},
                       {"ranks", or_null(performance.ranks)},
                       {"threads", or_null(performance.threads)},
                       {"wall_s", or_null(performance.wall_s)},
                       {"solve_s", or_null(performance.solve_s)},
                       {"insitu_s", or_null(performance.insitu_s)},
                       {"output_s", or_null(performance.output_s)},
                       {"bond_evaluations", or_null(performance.bond_evaluations)},
                       {"bond_evaluations_per_s", or_null(performance.bond_evaluations_per_s)},
                       {"flop", or_null(performance.flop)},
                       {"exchange_s", or_null(performance.exchange_s)},
                       {"exchange_bytes", or_null(performance.exchange_bytes)},
                       {"message_latency_s", or_null(performance.message_latency_s)},
                       {"message_bandwidth_B_s", or_null(performance.message_bandwidth_B_s)},
                       {"peak_rss_bytes", or_null(performance.peak_rss_bytes)},
                       {"node_hours", or_null(performance.node_hours)},
                       {"energy_J", or_null(performance.energy_J)}});
}

}  // namespace rhexis::runtime
