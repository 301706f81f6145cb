// SPDX-License-Identifier: BSD-3-Clause
/// Steady flow in the tree pair, of any size, without storing it (Sec. 3.3; the recursion in subtree.hpp).
///
/// The tree is cut twice: its top (up to 12 generations, known to every rank), up to 2^12 branches that ranks
/// and threads share out, and in each branch bottom subtrees of up to 11 generations that stay in cache. The
/// way up leaves one resistance for each bottom subtree; the way down grows each of them once more. All that
/// ranks tell each other on the way up is one resistance for each branch. Results do not depend on ranks and
/// threads, to the last bit.
///
/// Where all vessels of a generation are alike, one stands for all: O(k).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "hemodynamics/steady/tree/subtree.hpp"
#include "hemodynamics/steady/tree/tree_law.hpp"
#include "network/graph.hpp"
#include "network/tree/tree_pair.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::hemodynamics {

/// What is known at the two ends: a pressure at one at least, and a second pressure or the flow.
struct TreeBoundary {
  std::optional<double> inlet_pressure;   ///< Pa, at the near end of the first artery
  std::optional<double> outlet_pressure;  ///< Pa, at the near end of the last vein
  std::optional<double> flow;             ///< m3/s
};

/// The same as the conditions of a graph, at its junctions where blood enters and leaves the tree.
std::vector<network::BoundaryCondition> conditions_of(const TreeBoundary& boundary, std::uint32_t inlet,
                                                      std::uint32_t outlet);

/// One vessel's part in the flow.
struct VesselFlow {
  double flow = 0;                            ///< m3/s
  double pressure_from = 0, pressure_to = 0;  ///< Pa, at its ends in the direction of flow
};

/// Artery and vein at one place of the tree.
struct PlaceFlow {
  double flow = 0;                         ///< m3/s, through both
  double artery_near = 0, artery_far = 0;  ///< Pa; near: the end next to the root
  double vein_near = 0, vein_far = 0;
};

/// Floating-point operations for an artery and its vein on the way up, where splits and lengths are random
/// and veins follow arteries: split 4 (8 for each of half the places), length 6, table 16 and factor 1, sum 4
/// ...
inline constexpr double flop_up = 31;
/// ... and on the way down those again, with flows and pressures 7, radius and length 17. (Executed, by
/// callgrind: 31.7 and 56.0.) What consumers do is not counted.
inline constexpr double flop_down = flop_up + 24;

/// Gets the vessels of a sweep. Called by one thread.
class VesselConsumer {
 public:
  virtual ~VesselConsumer() = default;
  virtual void consume(const VesselBlock& block) = 0;
  /// Comes at moments that do not depend on ranks and threads: sums of doubles made between two of them are
  /// the same everywhere.
  virtual void pause() {}
};

class TreeFlow {
 public:
  /// Finds the resistance of the whole: the way up, over all vessels. Collective. Throws InputError for a
  /// boundary that does not determine the flow. `one_by_one`: every vessel streams by, also where one could
  /// stand for its generation, because consumers tell them apart.
  TreeFlow(const network::TreePair& tree, const Viscosity& viscosity, const TreeBoundary& boundary,
           parallel::Communicator comm, bool one_by_one = false);

  /// Memory that it takes on all ranks together, where the vessels of a generation differ.
  static double bytes(int generations, int ranks);

  double resistance() const { return resistance_; }  ///< Pa s/m3, of the whole
  double flow() const { return root_.flow; }         ///< m3/s
  double inlet_pressure() const { return root_.artery_pressure; }
  double outlet_pressure() const { return root_.vein_pressure; }
  const TreeBoundary& boundary() const { return boundary_; }
  const network::TreePair& tree() const { return tree_; }
  const TreeLaw& law() const { return law_; }

  /// The way down: every vessel once, in blocks with geometry, each to the consumer of the thread that
  /// computes it
  /// (`consumer_of(thread)`); each rank sees the vessels that it owns, the first rank those of the top too.
  void sweep(const std::function<VesselConsumer&(int thread)>& consumer_of) const;

  /// Artery and vein at each of some places, in their order. Collective; cheapest where neighbours in the
  /// list are neighbours in the tree: up to 2^12 places are grown for each that is not near the one before.
  std::vector<PlaceFlow> at(const std::vector<std::uint64_t>& places) const;
  /// A vessel by its id. Collective. Throws InputError where there is none.
  VesselFlow query(std::uint64_t id) const;

  /// Resistances that the way from the root to `place` meets, for re-solving it when something on it changes.
  struct Path {
    std::vector<double> artery, vein;  ///< resistances of the vessels on the way, root first, Pa s/m3
    std::vector<double>
        beside;        ///< resistance of the subtree pair that branches off below each but the last, Pa s/m3
    double below = 0;  ///< resistance of what hangs below the last, Pa s/m3; 0 in the last generation
  };
  /// Collective.
  Path path_to(std::uint64_t place) const;

 private:
  class Reader;

  void rise_alike();
  template <class Work>
  void for_each_branch(const Work& work) const;
  void rise_branches();
  double rise_branch(Subtree& middle, Subtree& bottom, std::size_t branch);
  void grow_middle(Subtree& middle, std::size_t branch) const;
  void sweep_branch(Subtree& middle, Subtree& bottom, std::size_t branch, VesselConsumer& consumer) const;
  void sweep_alike(VesselConsumer& consumer) const;
  std::vector<PlaceFlow> at_alike(const std::vector<std::uint64_t>& places) const;
  bool owns(std::size_t branch) const { return branch >= first_branch_ && branch < past_branch_; }
  std::size_t branches() const { return std::size_t{1} << top_depth_; }
  SubtreeState branch_state(std::size_t branch) const { return top_->daughter(branch); }

  network::TreePair tree_;
  TreeBoundary boundary_;
  TreeLaw law_;
  parallel::Communicator comm_;
  bool alike_;
  int top_depth_ = 0, middle_depth_ = 0, bottom_depth_ = 0;
  std::size_t first_branch_ = 0, past_branch_ = 0;  ///< branches of this rank
  std::unique_ptr<Subtree> top_;
  std::vector<double> bottom_resistance_;  ///< [own branches][2^middle_depth]
  std::vector<double> alike_below_;        ///< [k] resistance of a subtree pair from a generation on
  double resistance_ = 0;
  SubtreeState root_;
};

}  // namespace rhexis::hemodynamics
