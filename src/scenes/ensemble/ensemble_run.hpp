// SPDX-License-Identifier: BSD-3-Clause
/// Probability of rupture against pressure: many vessels with scattered walls, shared among the ranks.
#pragma once

#include "scenes/ensemble/ensemble_scene.hpp"

namespace rhexis::scenes {

/// Files of results: a row per vessel, kept while the run goes on, and a row per pressure at its end.
inline constexpr const char* samples_name = "samples.csv";
inline constexpr const char* probability_name = "probability.csv";

/// The same run into the same folder goes on from the samples that are there. Rows and their order do not
/// depend on ranks, threads or restarts. Throws RunError (after noting it in run.json) or InputError (nothing
/// written). Collective.
runtime::Ending run(EnsembleScene scene, const runtime::RunOptions& options, parallel::Communicator comm);

}  // namespace rhexis::scenes
