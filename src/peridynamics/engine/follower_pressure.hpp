// SPDX-License-Identifier: BSD-3-Clause
/// A pressure that follows the wall, on the deformed lumen (loads/lumen_surface.hpp), borne by the columns of
/// the pressure layer.
///
/// It derives from the potential -P (V + sum A0 |d|), of the volume V inside the surface of the nodes y_t and
/// of the distance d from a node to the mean of its layer, d = sum_j s_j x_j - y, times the area A0 that
/// belongs to the node on the undeformed wall. So particle j bears
///   P (e_j A + (s_j - e_j) A0 d/|d|)
/// of a node: the whole is exactly P A, the pressure on the deformed surface, and the second part, which
/// sums to zero, spreads it over the layer's depth as it is spread on the undeformed wall, P s_j A0. (A force
/// P s_j A derives from no potential, and makes short waves grow.)
///
/// A patch is torn once an edge of it is `torn_edge` times as long as an unbroken bond along it can be: no
/// pressure acts on it, nor on a particle without any intact bond. Beyond the ends of the vessel the surface
/// goes on straight for half a row, which makes up for the half row by which end particles stand inside it.
///
/// Positions are those that bonds read, and every node's forces are found from its own nine nodes in a fixed
/// order: the digits do not depend on ranks and threads.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/threads.hpp"
#include "peridynamics/engine/body_setup.hpp"
#include "peridynamics/engine/bond_storage.hpp"
#include "peridynamics/engine/domain.hpp"

namespace rhexis::peridynamics {

/// Length of a torn patch's edge over that of the longest unbroken bond along it: as for the gaps that
/// OpeningGauge counts.
inline constexpr double torn_edge = 1.5;

template <class Real>
class FollowerPressure {
 public:
  /// Keeps pointers to `setup` and `domain`.
  FollowerPressure(const BodySetup& setup, const Domain& domain, int threads)
      : setup_(&setup), domain_(&domain), threads_(threads) {
    if (none()) return;
    choose_nodes();
    place_ = make_vectors(nodes_.size());
    area_ = make_vectors(own_nodes_);
    spread_ = make_vectors(own_nodes_);
    if (!setup.thin_spots.none()) find_row_weights();
    longest_stretch_ = torn_edge * (1 + setup.critical_stretch *
                                            setup.heterogeneity.largest(setup.lattice).critical_stretch);
    loose_.resize(static_cast<std::size_t>(domain.layout().column_count * domain.blocks()));
  }

  /// Memory that this takes on all ranks.
  static double bytes(const BodySize& size) {
    if (size.lumen_nodes == 0) return 0;
    const double row_weights = size.thinned ? 2 * size.particles() * sizeof(double) : 0;
    return 9 * size.lumen_nodes * size.rows * sizeof(double) + size.blocks() * sizeof(std::uint16_t) +
           row_weights;
  }

  /// The load is dead, and nothing else may be asked.
  bool none() const { return setup_->lumen.none(); }

  /// By how much the load on a particle can exceed that on the undeformed wall.
  double largest_growth() const { return none() ? 1 : longest_stretch_ * longest_stretch_; }

  /// Finds the forces for the displacement `u` (padded, halo filled, in spacings).
  void find_forces(std::array<const Real*, 3> u) {
    parallel::for_each_share(threads_, nodes_.size(), [&](int, std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) find_place(n, u);
    });
    parallel::for_each_share(threads_, own_nodes_, [&](int, std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        find_depth(n, u);
        find_node_forces(n);
      }
    });
  }

  /// Force per volume (1/m, for a pressure of 1) on each row of a block of a loaded column; 0 on loose
  /// particles.
  void load(RowBlock b, BondStorage<Real>& bonds, double (&load)[3][block_rows]) {
    if (bonds.take_loosened(b)) loose_[domain_->number(b)] = bonds.rows_without_bonds(b);
    const std::int64_t row = b.block * block_rows;
    const int rows = domain_->rows_in(b.block);
    const double per_volume = 1 / setup_->lattice.volume(domain_->global_column(b.slot));
    for (int k = 0; k < 3; ++k) {
      double* const out = load[k];
      std::fill_n(out, block_rows, 0.0);
      const auto slot = static_cast<std::size_t>(b.slot);
      for (std::size_t i = first_place_[slot]; i < first_place_[slot + 1]; ++i) {
        const double* const area = area_[k].data() + index(places_[i].node, row);
        const double* const spread = spread_[k].data() + index(places_[i].node, row);
        with_weights(places_[i].member, row, [&](const auto& weight, const auto& share) {
          for (int lane = 0; lane < rows; ++lane)
            out[lane] += per_volume * (weight(lane) * area[lane] + share(lane) * spread[lane]);
        });
      }
      for (unsigned loose = loose_[domain_->number(b)]; loose != 0; loose &= loose - 1)
        out[std::countr_zero(loose)] = 0;
    }
  }

 private:
  using Vectors = std::array<std::vector<double>, 3>;  ///< [nodes][stride()]
  struct Vector {
    double x, y, z;
    double squared() const { return x * x + y * y + z * z; }
  };
  static Vector minus(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

  /// Numbers of nodes and members are local ones.
  struct Node {
    std::int32_t global;
    std::size_t previous = 0, next = 0;  ///< of own nodes only
    std::size_t first_member = 0, past_member = 0;
  };
  struct Member {
    std::size_t values;           ///< index of its first owned row in padded arrays
    std::array<double, 3> place;  ///< m, (x, y, 0)
    double weight, share;
  };
  /// What an owned column is to a node.
  struct Place {
    std::size_t node, member;
  };

  /// Values of a node: the owned rows, and one more at either end.
  std::size_t stride() const { return static_cast<std::size_t>(domain_->layout().row_count) + 2; }
  std::size_t index(std::size_t node, std::int64_t row) const {
    return node * stride() + static_cast<std::size_t>(row + 1);
  }
  Vectors make_vectors(std::size_t nodes) const {
    const std::vector<double> component(nodes * stride());
    return {component, component, component};
  }

  /// Calls `use(weight, share)` with functions of how far a row is behind `row`.
  template <class Use>
  void with_weights(std::size_t member, std::int64_t row, const Use& use) const {
    if (row_weights_.empty()) {
      use([w = members_[member].weight](std::ptrdiff_t) { return w; },
          [s = members_[member].share](std::ptrdiff_t) { return s; });
    } else {
      const std::size_t first = index(member, row);
      use([w = row_weights_.data() + first](std::ptrdiff_t i) { return w[i]; },
          [s = row_shares_.data() + first](std::ptrdiff_t i) { return s[i]; });
    }
  }

  /// Numbers the nodes that owned columns bear, and then their neighbours.
  void choose_nodes() {
    const LumenSurface& surface = setup_->lumen;
    const ColumnLayout& l = domain_->layout();
    const auto owned = [&](const LumenSurface::Member& m) {
      return m.column >= l.first_column && m.column < l.first_column + l.column_count;
    };
    std::vector<std::size_t> local(static_cast<std::size_t>(surface.size()), SIZE_MAX);
    const auto take = [&](std::int32_t t) {
      std::size_t& number = local[static_cast<std::size_t>(t)];
      if (number == SIZE_MAX) {
        number = nodes_.size();
        nodes_.push_back({.global = t});
      }
      return number;
    };
    for (std::int32_t t = 0; t < surface.size(); ++t) {
      if (std::ranges::any_of(surface.of(t), owned)) take(t);
    }
    own_nodes_ = nodes_.size();
    for (std::size_t n = 0; n < own_nodes_; ++n) {
      const std::int32_t global = nodes_[n].global;
      const std::size_t previous = take(surface.previous(global)), next = take(surface.next(global));
      nodes_[n].previous = previous;
      nodes_[n].next = next;
    }
    std::vector<std::vector<Place>> places(static_cast<std::size_t>(l.column_count));
    const CrossSection& section = setup_->lattice.section;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      nodes_[n].first_member = members_.size();
      for (const LumenSurface::Member& m : surface.of(nodes_[n].global)) {
        const auto c = static_cast<std::size_t>(m.column);
        if (n < own_nodes_ && owned(m))
          places[static_cast<std::size_t>(m.column - l.first_column)].push_back({n, members_.size()});
        members_.push_back({.values = domain_->padded(domain_->slot(m.column)),
                            .place = {section.x[c], section.y[c], 0},
                            .weight = m.weight,
                            .share = m.share});
      }
      nodes_[n].past_member = members_.size();
    }
    first_place_.push_back(0);
    for (const std::vector<Place>& of_column : places) {
      places_.insert(places_.end(), of_column.begin(), of_column.end());
      first_place_.push_back(places_.size());
    }
  }

  /// Weights and shares of each row where thin spots leave out some of the layer's particles.
  void find_row_weights() {
    row_weights_.resize(members_.size() * stride());
    row_shares_.resize(members_.size() * stride());
    const std::int64_t rows = domain_->layout().rows;
    std::vector<std::array<double, 2>> points;
    std::vector<double> shares;
    for (const Node& node : nodes_) {
      for (std::int64_t row = -1; row <= domain_->layout().row_count; ++row) {
        const double z = setup_->lattice.height((domain_->layout().first_row + row + rows) % rows);
        points.clear();
        shares.clear();
        double total = 0;
        for (std::size_t m = node.first_member; m < node.past_member; ++m) {
          const auto& [x, y, unused] = members_[m].place;
          points.push_back({x, y});
          shares.push_back(members_[m].share * setup_->thin_spots.load_share(x, y, z));
          total += shares.back();
        }
        for (double& share : shares) share /= total;
        const std::vector<double> weights = extrapolation_weights(points, shares, setup_->inner_radius);
        for (std::size_t j = 0; j < shares.size(); ++j) {
          row_shares_[index(node.first_member + j, row)] = shares[j];
          row_weights_[index(node.first_member + j, row)] = weights[j];
        }
      }
    }
  }

  /// Displacement (m) of a node in all rows.
  void find_place(std::size_t n, std::array<const Real*, 3> u) {
    const ColumnLayout& l = domain_->layout();
    const auto count = static_cast<std::ptrdiff_t>(stride());
    for (std::size_t k = 0; k < 3; ++k) {
      double* const out = place_[k].data() + index(n, -1);
      std::fill_n(out, count, 0.0);
      for (std::size_t m = nodes_[n].first_member; m < nodes_[n].past_member; ++m) {
        const Real* const in = u[k] + members_[m].values - 1;
        with_weights(m, -1, [&](const auto& weight, const auto&) {
          for (std::ptrdiff_t i = 0; i < count; ++i)
            out[i] += weight(i) * (setup_->lattice.spacing * static_cast<double>(in[i]));
        });
      }
      if (domain_->periodic()) continue;
      const bool one = l.rows == 1;
      if (l.first_row == 0) out[0] = one ? out[1] : 2 * out[1] - out[2];
      if (l.first_row + l.row_count == l.rows)
        out[count - 1] = one ? out[count - 2] : 2 * out[count - 2] - out[count - 3];
    }
  }

  /// Puts the way (m) from an own node to the mean of its layer into `spread_`, in the owned rows.
  void find_depth(std::size_t n, std::array<const Real*, 3> u) {
    const auto rows = static_cast<std::ptrdiff_t>(domain_->layout().row_count);
    for (std::size_t k = 0; k < 3; ++k) {
      double* const out = spread_[k].data() + index(n, 0);
      std::fill_n(out, rows, 0.0);
      for (std::size_t m = nodes_[n].first_member; m < nodes_[n].past_member; ++m) {
        const Real* const in = u[k] + members_[m].values;
        const double place = members_[m].place[k];
        with_weights(m, 0, [&](const auto& weight, const auto& share) {
          for (std::ptrdiff_t i = 0; i < rows; ++i)
            out[i] += (share(i) - weight(i)) * (place + setup_->lattice.spacing * static_cast<double>(in[i]));
        });
      }
    }
  }

  /// A patch as seen from one of its nodes: `p` and `q` lead along its edges to neighbours, anticlockwise as
  /// seen from outside the wall, `pq` to the node across.
  struct Patch {
    Vector p, q, pq;

    /// 1; 0 where an edge along p or q is longer than allowed (squares of lengths).
    double present(double longest_p, double longest_q) const {
      const bool whole = (p.squared() < longest_p) & (minus(pq, q).squared() < longest_p) &
                         (q.squared() < longest_q) & (minus(pq, p).squared() < longest_q);
      return whole ? 1.0 : 0.0;
    }
    /// 12 times the node's share of the vector area: the integral of its shape function over the normals of
    /// the bilinear patch.
    Vector area() const {
      const Vector d = minus(p, q);
      return {(p.y * q.z - p.z * q.y) + (d.y * pq.z - d.z * pq.y),
              (p.z * q.x - p.x * q.z) + (d.z * pq.x - d.x * pq.z),
              (p.x * q.y - p.y * q.x) + (d.x * pq.y - d.y * pq.x)};
    }
  };

  /// Makes `area_` and `spread_` of an own node.
  void find_node_forces(std::size_t n) {
    const LumenSurface& surface = setup_->lumen;
    const Node& node = nodes_[n];
    const auto chord = [&](std::int32_t to) {
      const auto& a = surface.nodes[static_cast<std::size_t>(node.global)];
      const auto& b = surface.nodes[static_cast<std::size_t>(to)];
      return Vector{b[0] - a[0], b[1] - a[1], 0};
    };
    const Vector none{0, 0, 0}, forth = chord(surface.next(node.global)),
                                back = chord(surface.previous(node.global));
    const double rise = setup_->lattice.row_spacing, longest = longest_stretch_ * longest_stretch_;
    const double longest_forth = longest * forth.squared(), longest_back = longest * back.squared(),
                 longest_rise = longest * rise * rise;
    const double factor = surface.area_factor / 12;
    const std::array<double, 2> undeformed = surface.undeformed_area(node.global);
    const double quarter_area = 0.25 * rise * std::hypot(undeformed[0], undeformed[1]);

    const double* const ux = place_[0].data();
    const double* const uy = place_[1].data();
    const double* const uz = place_[2].data();
    double* __restrict const ax = area_[0].data();
    double* __restrict const ay = area_[1].data();
    double* __restrict const az = area_[2].data();
    double* __restrict const dx = spread_[0].data();
    double* __restrict const dy = spread_[1].data();
    double* __restrict const dz = spread_[2].data();
    const std::size_t to_next = (node.next - n) * stride(), to_previous = (node.previous - n) * stride();
    for (std::size_t i = index(n, 0); i < index(n, domain_->layout().row_count); ++i) {
      const auto to = [&](std::size_t other, const Vector& apart, double up) {
        return Vector{apart.x + (ux[other] - ux[i]), apart.y + (uy[other] - uy[i]), up + (uz[other] - uz[i])};
      };
      const std::size_t e = i + to_next, w = i + to_previous;
      const Vector east = to(e, forth, 0), west = to(w, back, 0), north = to(i + 1, none, rise),
                   south = to(i - 1, none, -rise);
      const Patch north_east{east, north, to(e + 1, forth, rise)},
          north_west{north, west, to(w + 1, back, rise)}, south_west{west, south, to(w - 1, back, -rise)},
          south_east{south, east, to(e - 1, forth, -rise)};
      const double ne = north_east.present(longest_forth, longest_rise),
                   nw = north_west.present(longest_rise, longest_back),
                   sw = south_west.present(longest_back, longest_rise),
                   se = south_east.present(longest_rise, longest_forth);
      const Vector a = north_east.area(), b = north_west.area(), c = south_west.area(), d = south_east.area();
      const double depth = dx[i] * dx[i] + dy[i] * dy[i] + dz[i] * dz[i];
      const double spread = quarter_area * (ne + nw + sw + se) / (depth > 0 ? std::sqrt(depth) : 1.0);
      dx[i] *= spread;
      dy[i] *= spread;
      dz[i] *= spread;
      ax[i] = factor * ((ne * a.x + nw * b.x) + (sw * c.x + se * d.x)) - dx[i];
      ay[i] = factor * ((ne * a.y + nw * b.y) + (sw * c.y + se * d.y)) - dy[i];
      az[i] = factor * ((ne * a.z + nw * b.z) + (sw * c.z + se * d.z)) - dz[i];
    }
  }

  const BodySetup* setup_;
  const Domain* domain_;
  int threads_;
  double longest_stretch_ = 1;  ///< of an edge that is not torn
  std::vector<Node> nodes_;     ///< own nodes, then neighbours of theirs
  std::size_t own_nodes_ = 0;
  std::vector<Member> members_;
  std::vector<double> row_weights_, row_shares_;  ///< [members][stride()]; empty: the same in all rows
  std::vector<Place> places_;
  std::vector<std::size_t> first_place_;  ///< [owned columns + 1]
  Vectors place_;                         ///< m, displacement of nodes
  Vectors area_, spread_;                 ///< m2, of own nodes: A - A0 d/|d| and A0 d/|d|
  std::vector<std::uint16_t> loose_;      ///< [blocks] rows without an intact bond, of loaded columns
};

}  // namespace rhexis::peridynamics
