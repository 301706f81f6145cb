/// What a solved network leaves in the folder of results.
#pragma once

#include "app/network_tier.hpp"
#include "app/results.hpp"
#include "output/results_folder.hpp"

namespace rhexis::app {

/// generations.csv, histograms.csv, screening.csv, risk_histograms.csv, vessels.csv (what there is of them),
/// network.xdmf and .h5, network.vtkhdf, network.vtp. Collective. Throws InputError (a file in the way) and
/// RunError.
void write_network(const Configuration& c, NetworkSolution& solution, const output::ResultsFolder& folder,
                   parallel::Communicator comm);

/// As in run.json.
NetworkResults network_results(const NetworkSolution& solution);
nlohmann::ordered_json to_json(const QueriedVessel& q);

}  // namespace rhexis::app
