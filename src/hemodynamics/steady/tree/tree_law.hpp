// SPDX-License-Identifier: BSD-3-Clause
/// What a vessel of the tree pair is like as a function of its capacity (network/tree/tree_rules.hpp) alone,
/// tabulated: the rules, the viscosity law and Eq. (9) in one look-up. What depends on the generation or on
/// the vessel itself is a factor on its length.
#pragma once

#include <vector>

#include "hemodynamics/viscosity.hpp"
#include "network/interval_table.hpp"
#include "network/tree/tree_pair.hpp"

namespace rhexis::hemodynamics {

struct TreeLaw {
  TreeLaw(const network::TreePair& tree, const Viscosity& viscosity);

  /// Resistance (Pa s/m3, Eq. 9) of an artery of unit length factor.
  network::IntervalTable artery_resistance;
  /// The same table for its vein; empty where that is `vein_factor` times the artery's.
  network::IntervalTable vein_resistance;
  bool vein_follows = true;
  double vein_factor = 1;
  /// Radius of the artery (m): the tree's, which must outlive this.
  const network::IntervalTable& radius;
  /// Length (m) at unit length factor; empty where that is the radius.
  network::IntervalTable length;
  bool length_is_radius = true;
  /// Factor on lengths of a generation.
  std::vector<double> generation_factor;

  std::uint64_t seed;
  bool random_splits, random_lengths;
  double least_offset, offset_range;  ///< range of the wider daughter's share above 1/2
  double length_spread;
};

}  // namespace rhexis::hemodynamics
