// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/loads/lumen_surface.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace rhexis::peridynamics {
namespace {

constexpr double spacings_per_node = 2;  ///< on a lattice, whose columns stand in no rays

/// Share of each column in the force of each node it is near to, before these add up to 1: [nodes].
using Shares = std::vector<std::vector<LumenSurface::Member>>;

double load_of(const PressureLayer& layer, const Lattice& lattice, std::size_t c) {
  return std::hypot(layer.bx[c], layer.by[c]) * lattice.section.area[c];
}

/// Polar: the columns of a ray follow one another.
Shares shares_of_rays(const Lattice& lattice, const PressureLayer& layer) {
  const auto rings = static_cast<std::size_t>(lattice.section.rings);
  Shares shares(static_cast<std::size_t>(lattice.section.per_ring));
  for (std::size_t c = 0; c < lattice.section.size(); ++c) {
    if (layer.loads(c))
      shares[c / rings].push_back({static_cast<std::int32_t>(c), load_of(layer, lattice, c), 0});
  }
  return shares;
}

/// Nodes at equal angles; a column belongs to the two that it stands between, to each the more the nearer.
Shares shares_of_sectors(const Lattice& lattice, const PressureLayer& layer, double rotation,
                         std::size_t nodes) {
  Shares shares(nodes);
  const CrossSection& s = lattice.section;
  const auto count = static_cast<double>(nodes);
  for (std::size_t c = 0; c < s.size(); ++c) {
    if (!layer.loads(c)) continue;
    const double turns = (std::atan2(s.y[c], s.x[c]) - rotation) / (2 * std::numbers::pi);
    const double place = count * (turns - std::floor(turns));
    const double before = std::floor(place), nearness = place - before;
    const auto node = static_cast<std::size_t>(before) % nodes;
    const double load = load_of(layer, lattice, c);
    const auto column = static_cast<std::int32_t>(c);
    if (nearness < 1) shares[node].push_back({column, load * (1 - nearness), 0});
    if (nearness > 0) shares[(node + 1) % nodes].push_back({column, load * nearness, 0});
  }
  return shares;
}

Shares find_shares(const Parameters& p, const Lattice& lattice, const PressureLayer& layer) {
  if (lattice.section.per_ring > 0) return shares_of_rays(lattice, layer);
  const double around = 2 * std::numbers::pi * p.inner_radius / (spacings_per_node * lattice.spacing);
  return shares_of_sectors(lattice, layer, p.rotation,
                           std::max<std::size_t>(6, static_cast<std::size_t>(around)));
}

}  // namespace

std::vector<double> extrapolation_weights(std::span<const std::array<double, 2>> points,
                                          std::span<const double> shares, double inner_radius) {
  std::array<double, 2> mean{};
  for (std::size_t j = 0; j < points.size(); ++j) {
    for (std::size_t k = 0; k < 2; ++k) mean[k] += shares[j] * points[j][k];
  }
  const double radius = std::hypot(mean[0], mean[1]);
  // Along the radius and across it, in radii, from the place at the lumen.
  Eigen::MatrixXd basis(3, points.size());
  for (std::size_t j = 0; j < points.size(); ++j) {
    const auto& [x, y] = points[j];
    basis.col(static_cast<Eigen::Index>(j)) << 1,
        ((x * mean[0] + y * mean[1]) / radius - inner_radius) / inner_radius,
        (y * mean[0] - x * mean[1]) / (radius * inner_radius);
  }
  const Eigen::Map<const Eigen::VectorXd> s(shares.data(), static_cast<Eigen::Index>(shares.size()));
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> moments;
  moments.setThreshold(1e-9);
  moments.compute(basis * s.asDiagonal() * basis.transpose());
  const Eigen::VectorXd e = s.cwiseProduct(basis.transpose() * moments.solve(Eigen::Vector3d(1, 0, 0)));
  if ((basis * e - Eigen::Vector3d(1, 0, 0)).norm() > 1e-6) return {shares.begin(), shares.end()};
  return {e.begin(), e.end()};
}

/// Half the chord between its neighbours, turned outwards.
std::array<double, 2> LumenSurface::undeformed_area(std::int32_t node) const {
  const auto& before = nodes[static_cast<std::size_t>(previous(node))];
  const auto& after = nodes[static_cast<std::size_t>(next(node))];
  return {0.5 * area_factor * (after[1] - before[1]), -0.5 * area_factor * (after[0] - before[0])};
}

LumenSurface make_lumen_surface(const Parameters& p, const Lattice& lattice, const PressureLayer& layer) {
  const CrossSection& s = lattice.section;
  LumenSurface surface;
  surface.first.push_back(0);
  for (std::vector<LumenSurface::Member>& members : find_shares(p, lattice, layer)) {
    double total = 0;
    for (const LumenSurface::Member& m : members) total += m.share;
    if (total == 0)
      throw InputError(
          "the loaded layer's particles leave gaps around the lumen, on which no pressure can act; take a "
          "thicker layer or a smaller spacing, or load.direction = \"dead\"",
          "load.layer_thickness");
    std::vector<std::array<double, 2>> points;
    std::vector<double> shares;
    for (LumenSurface::Member& m : members) {
      m.share /= total;
      const auto c = static_cast<std::size_t>(m.column);
      points.push_back({s.x[c], s.y[c]});
      shares.push_back(m.share);
    }
    const std::vector<double> weights = extrapolation_weights(points, shares, p.inner_radius);
    std::array<double, 2> node{};
    for (std::size_t j = 0; j < members.size(); ++j) {
      members[j].weight = weights[j];
      for (std::size_t k = 0; k < 2; ++k) node[k] += weights[j] * points[j][k];
    }
    surface.nodes.push_back(node);
    surface.members.insert(surface.members.end(), members.begin(), members.end());
    surface.first.push_back(static_cast<std::int32_t>(surface.members.size()));
  }
  double dead = 0, following = 0;  // resultants per length and unit of pressure
  for (std::size_t c = 0; c < s.size(); ++c) dead += load_of(layer, lattice, c);
  for (std::int32_t t = 0; t < surface.size(); ++t) {
    const auto [x, y] = surface.undeformed_area(t);
    following += std::hypot(x, y);
  }
  surface.area_factor = dead / following;
  return surface;
}

PressureLayer undeformed_load(const LumenSurface& surface, const Lattice& lattice) {
  const std::size_t columns = lattice.section.size();
  PressureLayer layer{std::vector<double>(columns), std::vector<double>(columns)};
  for (std::int32_t t = 0; t < surface.size(); ++t) {
    const auto [x, y] = surface.undeformed_area(t);
    for (const LumenSurface::Member& m : surface.of(t)) {
      const auto c = static_cast<std::size_t>(m.column);
      layer.bx[c] += m.share * x / lattice.section.area[c];
      layer.by[c] += m.share * y / lattice.section.area[c];
    }
  }
  return layer;
}

}  // namespace rhexis::peridynamics
