// SPDX-License-Identifier: BSD-3-Clause
/// Statistics of all vessels of a tree pair, gathered while they stream by: totals, and by generation the
/// mean, least and most of radius, flow, pressure and hoop stress, with histograms. Exact sums: the same for
/// any ranks and threads.
///
/// A vessel's pressure is the mean of its two ends', relative to atmosphere; its hoop stress that at the
/// lumen (network/wall.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hemodynamics/steady/tree/bins.hpp"
#include "hemodynamics/steady/tree/tree_flow.hpp"

namespace rhexis::hemodynamics {

struct Spread {
  double mean = 0, least = 0, most = 0;
};

/// What is known of one generation; index 0 for arteries, 1 for veins.
struct GenerationStatistics {
  int generation = 0;
  double vessels = 0;  ///< vessels of each kind
  std::array<Spread, 2> radius, pressure, hoop_stress;
  std::array<double, 2> volume{}, surface{};  ///< m3, m2 of lumen
  double mean_length = 0;                     ///< m
  Spread flow;                                ///< the same for arteries and veins
  std::vector<std::uint64_t> flow_counts;     ///< [flow_bins.count]
  std::array<std::vector<std::uint64_t>, 2> pressure_counts, stress_counts;
};

struct TreeStatistics {
  std::vector<GenerationStatistics> generations;
  Bins pressure_bins, flow_bins, stress_bins;
  double volume = 0, surface = 0;  ///< m3, m2, of all vessels
  double narrow_vessels = 0;       ///< below the viscosity law's least diameter
};

/// One sweep over all vessels, which other consumers may ride along. Collective.
TreeStatistics gather_statistics(const TreeFlow& flow, const Viscosity& viscosity,
                                 parallel::Communicator comm,
                                 const std::function<VesselConsumer&(int thread)>& also = {});

}  // namespace rhexis::hemodynamics
