// SPDX-License-Identifier: BSD-3-Clause
/// What a solved network leaves in the folder of results.
#pragma once

#include <string>
#include <vector>

#include "output/results_folder.hpp"
#include "output/series_plan.hpp"
#include "studies/flow/solved_network.hpp"

namespace rhexis::studies {

/// How a network is stored.
struct NetworkFilesPlan {
  std::string title, version;  ///< title of the run and version of the program, for the files of lines
  std::vector<output::SeriesFormat> formats;
  bool vtp = false;  ///< network.vtp besides
};

/// The names of the files that `write_network` makes of the problem's solution. `screens`: its vessels are
/// screened.
std::vector<std::string> network_file_names(const NetworkFilesPlan& plan,
                                            const hemodynamics::FlowProblem& problem, bool screens);

/// generations.csv, histograms.csv, screening.csv, risk_histograms.csv, vessels.csv (what there is of them),
/// network.xdmf and .h5, network.vtkhdf, network.vtp. Collective. Throws InputError (a file in the way) and
/// RunError.
void write_network(const NetworkFilesPlan& plan, SolvedNetwork& network, const output::ResultsFolder& folder,
                   parallel::Communicator comm);

}  // namespace rhexis::studies
