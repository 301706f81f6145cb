// SPDX-License-Identifier: BSD-3-Clause
/// Steady flow in one subtree pair - a place of the artery tree with some generations below it, and their
/// mirror in the vein tree - small enough to stay in cache.
///
/// An artery and a vein hang on either side of what lies below them, so every subtree pair is one resistance:
///   up:    R_i = R_artery + R_vein + R_1 R_2 / (R_1 + R_2)      (daughters 1 and 2)
///   down:  Q_1 = Q_i R_2 / (R_1 + R_2),  Q_2 = Q_i R_1 / (R_1 + R_2)
/// Nothing is subtracted on the way, so all flows are exact to a few roundings. Pressures follow from flows
/// (Eq. 9), down the arteries and up the veins from the roots.
///
/// Local place n of the subtree (1: its root; daughters 2n, 2n + 1) stands at index n of every array:
/// generation l at [2^l, 2^(l+1)), aligned for vectors.
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstdint>

#include "hemodynamics/steady/tree/tree_law.hpp"
#include "network/tree/random_stream.hpp"

namespace rhexis::hemodynamics {

/// What a subtree gets from above.
struct SubtreeState {
  std::uint64_t place = 1;  ///< place of its root in the whole tree
  double capacity = 1;
  double flow = 0;             ///< m3/s
  double artery_pressure = 0;  ///< at the near end of its first artery, Pa
  double vein_pressure = 0;    ///< at the near end of its last vein, Pa
};

/// Vessels of one generation, side by side: arrays of `count` values, for the places [first_place, + count)
/// of both trees. Each stands for `multiplicity` vessels like it (1 unless all vessels of a generation are
/// alike).
struct VesselBlock {
  int generation = 0;
  std::uint64_t first_place = 0;
  std::size_t count = 0;
  double multiplicity = 1;
  const double* radius = nullptr;       ///< artery's radius, m; the vein's is vein_radius_ratio times that
  const double* length = nullptr;       ///< length of artery and vein each, m
  const double* flow = nullptr;         ///< through both, m3/s
  const double* artery_near = nullptr;  ///< pressures, Pa: at the end next to the root,
  const double* artery_far = nullptr;   ///< at the end next to the midplane,
  const double* vein_near = nullptr;    ///< and the same of the vein
  const double* vein_far = nullptr;
};

class Subtree {
 public:
  /// For subtrees of `depth` generations. Open ones have daughters below the last generation, whose
  /// resistances are given and whose states are asked for.
  Subtree(const TreeLaw& law, int depth, bool open);

  /// Capacities, lengths and resistances of all vessels below a place.
  void grow(std::uint64_t place, double capacity);
  /// In an open subtree: where the resistances of the 2^depth daughters go, before `rise`.
  double* daughter_resistances() { return below_ + (std::size_t{1} << depth_); }
  /// Resistance of the whole, Pa s/m3 (at the far end, by the daughters' resistances).
  double rise();
  /// Flows and pressures, after `grow` and `rise`.
  void fall(const SubtreeState& state);
  /// State of daughter i of an open subtree, after `fall` (flow and pressures) or `grow` (place and
  /// capacity).
  SubtreeState daughter(std::size_t i) const;

  int depth() const { return depth_; }
  std::uint64_t place() const { return place_; }
  std::uint64_t global_place(std::size_t n) const;
  double capacity(std::size_t n) const { return capacity_[n]; }
  double below(std::size_t n) const { return below_[n]; }  ///< resistance of the subtree pair from n on
  double artery_resistance(std::size_t n) const { return artery_[n]; }
  double vein_resistance(std::size_t n) const {
    return law_.vein_follows ? artery_[n] * law_.vein_factor : vein_[n];
  }

  /// What is known at place n after `fall`: flow, then pressures at the artery's near and far end and the
  /// vein's near and far end.
  void state_of(std::size_t n, double values[5]) const;

  /// Vessels of local generation l, after `fall`; radius and length are null without geometry.
  VesselBlock block(int l, bool with_geometry);

 private:
  template <class InLanes, class Scalar>
  void draw_level(network::Stream stream, int l, double* out, const InLanes& in_lanes,
                  const Scalar& scalar) const;
  void split(int l);
  void set_resistances(int l);
  void rise(int l);
  void fall(int l);

  const TreeLaw& law_;
  int depth_;
  bool open_;
  std::uint64_t place_ = 1;
  int generation_ = 0;  ///< generation of the subtree's root
  hwy::AlignedFreeUniquePtr<double[]> memory_;
  double *capacity_, *artery_, *vein_, *below_, *flow_;
  double *artery_near_, *artery_far_, *vein_near_, *vein_far_;
  double *radius_, *length_, *factor_;
};

}  // namespace rhexis::hemodynamics
