// SPDX-License-Identifier: BSD-3-Clause
/// Rules of the recursive bifurcation that makes a vascular tree (Sec. 3.3).
///
/// A vessel of lumen radius r bifurcates so that  r^xi = r1^xi + r2^xi  (Murray 1926: xi = 3; Olufsen
/// 1999: 2.76). The *capacity*  a = (r / r_root)^xi  is therefore split like a fluid: the wider daughter gets
/// the share 1/2 + d, the other 1/2 - d. An asymmetry gamma = (r2/r1)^2 <= 1 fixes  1/2 + d = 1 / (1 +
/// gamma^(xi/2)). With random splits, d is drawn evenly between the values of the two asymmetries given, and
/// the wider side by a coin, from a counter-based stream: vessel by vessel, whatever the order of asking.
///
/// Lengths are lambda r, with lambda constant or by generation, or a curve of the radius; optionally each
/// vessel's own, even within 1 -+ spread. The venous tree is the arterial tree's mirror, with radii times
/// `vein_radius_ratio`.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parameter.hpp"
#include "network/wall.hpp"

namespace rhexis::network {

enum class TreeLayout { spatial, planar };

constexpr auto name_table(TreeLayout) {
  using enum TreeLayout;
  return std::to_array<Named<TreeLayout>>({{spatial, "spatial"}, {planar, "planar"}});
}

struct TreeRules {
  static constexpr int most_generations = 40;

  int generations = 0;     ///< k, of each tree: 2 (2^k - 1) vessels in all
  double root_radius = 0;  ///< m
  double exponent = 2.76;  ///< xi
  double asymmetry = 1;    ///< gamma
  double least_asymmetry =
      1;  ///< gamma of the least symmetric random split; `asymmetry` where splits are fixed
  std::uint64_t seed = 0;
  double length_ratio = 50;                                 ///< lambda
  std::vector<double> length_ratio_by_generation;           ///< instead, one for each generation
  std::vector<std::pair<double, double>> length_by_radius;  ///< instead, (r, L) in m, radii ascending
  double length_spread = 0;  ///< each vessel's length is even within (1 -+ spread) times the rule's
  double vein_radius_ratio = 1;
  Wall artery_wall, vein_wall;
  TreeLayout layout = TreeLayout::spatial;

  bool random_splits() const { return least_asymmetry < asymmetry; }
  bool random_lengths() const { return length_spread > 0; }
  /// All vessels of a generation are alike.
  bool repeats() const { return !random_splits() && !random_lengths() && asymmetry == 1; }

  double wider_share(double gamma) const;     ///< 1 / (1 + gamma^(xi/2))
  double narrower_share(double gamma) const;  ///< what that leaves
  /// Length by the rule, before the vessel's own factor (m).
  double length(int generation, double radius) const;
  /// Length (m) on the curve `length_by_radius`: straight between its points in logarithms of both, and
  /// beyond them along the outer lines.
  template <class Real>
  Real length_at(Real of_radius) const {
    std::size_t upper = 1;
    while (upper + 1 < length_by_radius.size() && of_radius >= Real(length_by_radius[upper].first)) ++upper;
    const Real r0 = length_by_radius[upper - 1].first, l0 = length_by_radius[upper - 1].second;
    const Real r1 = length_by_radius[upper].first, l1 = length_by_radius[upper].second;
    return l0 * std::pow(of_radius / r0, std::log(l1 / l0) / std::log(r1 / r0));
  }
};

/// xi such that a tree of k generations without asymmetry leads from `root` to `terminal` radius:
/// 2^(-(k-1)/xi).
double exponent_between(double root, double terminal, int generations);

/// The input keys of [tree], as read.
struct TreeParameters {
  std::optional<std::int64_t> generations;
  double root_radius = 0.0125;
  std::optional<double> exponent, terminal_radius, least_asymmetry;
  double asymmetry = 1;
  std::int64_t seed = 1;
  double length_ratio = 50;
  std::vector<double> length_ratio_by_generation;
  std::vector<CurvePoint> length_by_radius;
  double length_spread = 0;
  double vein_radius_ratio = 1;
  TreeLayout layout = TreeLayout::spatial;
};

ParameterList declare(TreeParameters& p);

/// Throws InputError, with its key, for values that do not fit together.
TreeRules rules_from(const TreeParameters& p, const Wall& artery_wall, const Wall& vein_wall);

}  // namespace rhexis::network
