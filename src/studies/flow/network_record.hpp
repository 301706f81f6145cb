// SPDX-License-Identifier: BSD-3-Clause
/// A network's flow in run.json.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "studies/flow/solved_network.hpp"

namespace rhexis::studies {

nlohmann::ordered_json to_json(const hemodynamics::NetworkVessel& vessel);

/// Names and values of the part `results.network`; all values are null where no network has been solved.
nlohmann::ordered_json network_record(const SolvedNetwork* network = nullptr);

}  // namespace rhexis::studies
