// SPDX-License-Identifier: BSD-3-Clause
/// Which vessels are at risk: lumen hoop strain against the wall's critical stretch, over all vessels.
///
/// risk = e / s0, with e the hoop strain at the lumen under the net pressure of the vessel's middle
/// (network/wall.hpp) and s0 the critical stretch of its wall: 1 where bonds at the lumen begin to break if
/// the load is slow. Vessels stream by; what stays is a list of those at highest risk and a histogram by
/// generation.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "hemodynamics/steady/tree/bins.hpp"
#include "hemodynamics/steady/tree/tree_flow.hpp"
#include "network/wall_variation.hpp"

namespace rhexis::screening {

struct Criterion {
  double critical_stretch = 0;  ///< critical stretch of a wall of strength 1
  double young_modulus = 1;     ///< Pa
  double poisson_ratio = 0.25;
  double outside_pressure = 0;  ///< Pa, taken off the blood's
};

/// `pressure`: of the blood, Pa; `relative_thickness`: h / r0 before the wall's factor.
double risk(const Criterion& criterion, double pressure, double relative_thickness,
            const network::WallFactors& wall);

struct RankedVessel {
  double risk = 0;
  std::uint64_t vessel = 0;  ///< id in a tree, index in a graph
  double alike = 1;          ///< vessels that it stands for: all of a generation where they are alike
};

/// What is known of one generation; index 0 for arteries and all that are not veins, 1 for veins.
struct GenerationRisk {
  std::array<double, 2> vessels{}, above{}, most{};  ///< counts; of those with a risk above 1; largest risk
  std::array<std::vector<std::uint64_t>, 2> counts;  ///< [bins.count]
};

struct Screening {
  hemodynamics::Bins bins;                  ///< histogram of the risk; the outermost bins hold all beyond
  std::vector<GenerationRisk> generations;  ///< [0]: of vessels without a generation, then from the root's
  std::vector<RankedVessel> top;            ///< highest risk first, then lowest number; risks above 0 only
  double vessels = 0, above = 0;
};

/// Counts and ranks what it is given; by one thread.
class RiskTally {
 public:
  RiskTally(int generations, std::size_t top);

  int generations() const { return static_cast<int>(generations_.size()) - 1; }

  /// `generation`: -1 where there is none.
  void add(int generation, network::VesselKind kind, const RankedVessel& vessel);
  /// Arteries or veins of one generation of a tree from place `first` on; `risks` filled up to whole vectors.
  void add(int generation, network::VesselKind kind, std::uint64_t first, const double* risks,
           std::size_t count);
  void add(const RiskTally& other);

  /// The sum of all ranks' tallies. Collective.
  Screening result(parallel::Communicator comm) const;

 private:
  bool enters(double risk) const {
    return risk > 0 && most_ > 0 && (list_.size() < most_ || risk >= list_.front().risk);
  }
  void enter(const RankedVessel& vessel);

  std::size_t most_;
  std::vector<RankedVessel> list_;  ///< a heap, the last to stay first
  std::vector<GenerationRisk> generations_;
};

/// Screens the vessels of a sweep over a tree, which all threads and ranks share out. Nothing depends on how.
class TreeScreening {
 public:
  TreeScreening(const network::TreePair& tree, const network::WallVariation& variation,
                const Criterion& criterion, std::size_t top);
  ~TreeScreening();

  hemodynamics::VesselConsumer& consumer(int thread);
  /// After the sweep. Collective.
  Screening result(parallel::Communicator comm) const;

 private:
  class Consumer;
  struct Context;
  std::unique_ptr<Context> context_;
  std::vector<std::unique_ptr<Consumer>> consumers_;
};

}  // namespace rhexis::screening
