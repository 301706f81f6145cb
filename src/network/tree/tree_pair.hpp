// SPDX-License-Identifier: BSD-3-Clause
/// The arterial tree and its venous mirror, joined leaf to leaf at the midplane (Sec. 3.3), as a function of
/// the vessel's id: nothing is stored, any of up to 2 (2^40 - 1) vessels can be asked for.
///
/// Numbering. A place in a tree is its heap number h: the root is 1, the daughters of h are 2h and 2h + 1.
/// Vessels have the id 2 (h - 1) + (0 for the artery, 1 for the vein): ids run from 0 without gaps, ancestors
/// first, and do not depend on the number of generations. Blood flows down the arteries and up the veins.
///
/// Junctions: 0, where blood enters; h (1 <= h < 2^k) the far end of artery h; 2^k, where it leaves; 2^k + h
/// (h < 2^(k-1)) the far end of vein h. The far end of a last vein is that of its artery.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "network/graph.hpp"
#include "network/interval_table.hpp"
#include "network/tree/tree_rules.hpp"

namespace rhexis::network {

/// One vessel in full.
struct TreeVessel {
  std::uint64_t id = 0;
  VesselKind kind = VesselKind::artery;
  int generation = 0;                                 ///< 0: root
  double radius = 0, length = 0, wall_thickness = 0;  ///< m
  Point start{}, end{};                               ///< m, in the direction of flow
  std::uint64_t from = 0, to = 0;                     ///< junctions, in the direction of flow
};

class TreePair {
 public:
  explicit TreePair(TreeRules rules);

  const TreeRules& rules() const { return rules_; }
  int generations() const { return rules_.generations; }
  std::uint64_t places() const { return (std::uint64_t{1} << generations()) - 1; }  ///< places of a vessel in each tree
  std::uint64_t vessels() const { return vessels_of(generations()); }
  static constexpr std::uint64_t vessels_of(int generations) { return (std::uint64_t{2} << generations) - 2; }
  std::uint64_t junctions() const { return 3 * (std::uint64_t{1} << (generations() - 1)); }

  static constexpr std::uint64_t id_of(std::uint64_t place, VesselKind kind) {
    return 2 * (place - 1) + (kind == VesselKind::vein ? 1 : 0);
  }
  static constexpr std::uint64_t place_of(std::uint64_t id) { return id / 2 + 1; }
  static constexpr VesselKind kind_of(std::uint64_t id) {
    return id % 2 == 0 ? VesselKind::artery : VesselKind::vein;
  }
  static int generation_of(std::uint64_t place);

  /// "artery.0110" or "vein.": the way from the root, 0 for the first daughter. The id of such a path, or of
  /// a plain number; throws InputError where there is no such vessel.
  static std::uint64_t id_of(std::string_view path, int generations);
  std::uint64_t id_of(std::string_view path) const { return id_of(path, generations()); }
  static std::string path_of(std::uint64_t id);

  /// Share of the first daughter of `place` in its capacity.
  double first_share(std::uint64_t place) const;
  /// (r / r_root)^xi of an artery: a product down from the root, O(k).
  double capacity(std::uint64_t place) const;
  double radius_of(double capacity) const { return radius_(capacity); }  ///< radius of an artery of that capacity, m
  const IntervalTable& radius_table() const { return radius_; }
  /// The vessel's own factor on its length (1 without spread).
  double length_factor(std::uint64_t place) const;
  /// Geometry of a vessel, O(k). Throws InputError for an id that does not exist.
  TreeVessel vessel(std::uint64_t id) const;

  /// All vessels as an explicit graph, in the order of ids, with junctions numbered as above. Throws RunError
  /// for more than 30 generations (junction numbers of 32 bits).
  Graph materialise(bool coordinates = true) const;

  /// One of several parts that together are the whole: the places of an even share of a generation with all
  /// that hangs below them; the first part also has what lies above. Junctions keep their numbers of the
  /// whole in `junction_id` [J]. Vessels in the order of ids are `vessel_id` [V].
  struct Part {
    Graph graph;
    std::vector<std::int64_t> junction_id, vessel_id;
  };
  Part materialise_part(int part, int parts) const;

  /// Position of the far end of an artery and what its daughters need of it.
  struct Place {
    double capacity = 1;
    Point end{};  ///< far end of the artery; the vein's is its mirror image, x -> -x
  };
  /// The root's near end: where blood enters.
  Point inlet() const { return {-reach_, 0, 0}; }
  static Point mirrored(const Point& p) { return {-p[0], p[1], p[2]}; }
  Place root_place() const;
  /// No artery has less capacity than this.
  double least_capacity() const;
  /// Both daughters of `place`, whose own state is `at`.
  std::array<Place, 2> daughters(std::uint64_t place, const Place& at) const;

 private:
  double advance_share(int generation, double radius, double length, double cosine) const;

  TreeRules rules_;
  IntervalTable radius_;
  double least_offset_ = 0, most_offset_ = 0;  ///< by how much the wider daughter's share exceeds 1/2
  std::vector<double> reach_per_radius_;  ///< [k + 1] how far a symmetric subtree reaches along the axis, in
                                          ///< radii of its root
  double reach_ = 0;                      ///< m, from inlet to midplane
};

}  // namespace rhexis::network
