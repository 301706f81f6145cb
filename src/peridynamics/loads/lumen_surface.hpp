// SPDX-License-Identifier: BSD-3-Clause
/// The lumen's surface as a tube's columns carry it: where a pressure acts that follows the wall.
///
/// Nodes go round the lumen, one for each ray of a polar cross-section, or one for some two spacings of a
/// lattice. In every row of particles the node t stands at
///   y_t = sum_j e_tj x_j,   sum_j e_tj = 1,
/// the positions x_j of the pressure layer's particles near it, extrapolated to r0 by a linear fit. Four
/// nodes, of two neighbours in two rows, span a bilinear patch. The pressure P gives node t of a row the
/// force P A_t, where A_t is the vector area (m2) that belongs to it: the integral of its shape function over
/// the normals of its patches, which is the derivative of the enclosed volume by y_t. Column j bears the
/// share s_tj of it that it bears of a dead load in the same layer, sum_j s_tj = 1; so both loads agree on an
/// undeformed wall.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "peridynamics/loads/pressure_layer.hpp"

namespace rhexis::peridynamics {

struct LumenSurface {
  /// A column near a node.
  struct Member {
    std::int32_t column;
    double share;   ///< s_tj, of the node's force
    double weight;  ///< e_tj, of the node's position
  };

  std::vector<std::array<double, 2>> nodes;  ///< m, (x, y) of the undeformed wall, once round
  std::vector<std::int32_t> first;           ///< [nodes + 1], where each node's members begin
  std::vector<Member> members;
  /// Makes the forces' resultant on the undeformed wall that of the dead load, whose lumen is round.
  double area_factor = 1;

  bool none() const { return nodes.empty(); }  ///< the load is dead
  std::int32_t size() const { return static_cast<std::int32_t>(nodes.size()); }
  std::span<const Member> of(std::int32_t node) const {
    const auto begin = first[static_cast<std::size_t>(node)],
               past = first[static_cast<std::size_t>(node) + 1];
    return {members.data() + begin, members.data() + past};
  }
  /// Vector area (x, y) of a node on the undeformed wall, per length of it, m.
  std::array<double, 2> undeformed_area(std::int32_t node) const;
  std::int32_t next(std::int32_t node) const { return node + 1 == size() ? 0 : node + 1; }
  std::int32_t previous(std::int32_t node) const { return node == 0 ? size() - 1 : node - 1; }
};

/// The surface that `layer` loads. Throws InputError where the layer's columns do not surround the lumen.
LumenSurface make_lumen_surface(const Parameters& p, const Lattice& lattice, const PressureLayer& layer);

/// Weights e_j that extrapolate to radius `inner_radius`, beside the mean direction of the points: s_j (a + b
/// . (x_j - x)), such that sum e_j = 1 and a linear field is met exactly at that place x; the shares
/// themselves where the points all have one radius. `shares` of points (x, y), at least 0, sum 1.
std::vector<double> extrapolation_weights(std::span<const std::array<double, 2>> points,
                                          std::span<const double> shares, double inner_radius);

/// The layer's load on the undeformed wall as the surface gives it, in place of the dead one.
PressureLayer undeformed_load(const LumenSurface& surface, const Lattice& lattice);

}  // namespace rhexis::peridynamics
