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
#include <utility>
#include <vector>

#include "parallel/threads.hpp"
#include "peridynamics/engine/body_setup.hpp"
#include "peridynamics/engine/bond_storage.hpp"
#include "peridynamics/engine/domain.hpp"
#include "peridynamics/engine/following_frame.hpp"
#include "peridynamics/laws/numbers.hpp"

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
    const double row_weights = size.thinned ? 2 * size.particles() * sizeof(Real) : 0;
    return 9 * size.lumen_nodes * size.rows * sizeof(Real) + size.blocks() * sizeof(std::uint16_t) +
           row_weights;
  }

  /// The load is dead, and nothing else may be asked.
  bool none() const { return setup_->lumen.none(); }

  /// By how much the load on a particle can exceed that on the undeformed wall.
  double largest_growth() const { return none() ? 1 : longest_stretch_ * longest_stretch_; }

  /// Finds the forces for the displacement `u` (padded, halo filled, in spacings; `wrapped` as by
  /// FollowingFrame).
  void find_forces(std::array<const Real*, 3> u, bool wrapped) {
    wrapped ? find_all<true>(u) : find_all<false>(u);
  }

  /// Force per volume (1/m, for a pressure of 1) on each row of a block of a loaded column; 0 on loose
  /// particles.
  void load(RowBlock b, BondStorage<Real>& bonds, double (&load)[3][block_rows]) {
    if (bonds.take_loosened(b)) loose_[domain_->number(b)] = bonds.rows_without_bonds(b);
    const std::int64_t row = b.block * block_rows;
    const double spacing = setup_->lattice.spacing;
    const double per_volume = spacing * spacing / setup_->lattice.volume(domain_->global_column(b.slot));
    for (int k = 0; k < 3; ++k) {
      Real sums[block_rows] = {};
      const auto slot = static_cast<std::size_t>(b.slot);
      for (std::size_t i = first_place_[slot]; i < first_place_[slot + 1]; ++i) {
        const Real* const area = area_[k].data() + index(places_[i].node, row);
        const Real* const spread = spread_[k].data() + index(places_[i].node, row);
        with_weights(places_[i].member, row, [&](const auto& weight, const auto& share) {
          for (std::size_t lane = 0; lane < block_rows; lane += lanes())
            (X::load(sums + lane) + weight(lane) * X::load(area + lane) +
             share(lane) * X::load(spread + lane))
                .store(sums + lane);
        });
      }
      for (int lane = 0; lane < block_rows; ++lane)
        load[k][lane] = per_volume * static_cast<double>(sums[lane]);
      for (unsigned loose = loose_[domain_->number(b)]; loose != 0; loose &= loose - 1)
        load[k][std::countr_zero(loose)] = 0;
    }
  }

 private:
  using D = hn::CappedTag<Real, block_rows>;
  using X = Lanes<D>;
  static std::size_t lanes() { return hn::Lanes(D()); }

  using Vectors = std::array<std::vector<Real>, 3>;  ///< [nodes][stride()]
  struct Vector {
    X x, y, z;
    friend HWY_INLINE Vector operator-(const Vector& a, const Vector& b) {
      return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    HWY_INLINE X squared() const { return x * x + y * y + z * z; }
  };

  /// Numbers of nodes and members are local ones.
  struct Node {
    std::int32_t global;
    std::size_t previous = 0, next = 0;  ///< of own nodes only
    std::size_t first_member = 0, past_member = 0;
  };
  struct Member {
    std::size_t values;         ///< index of its first owned row in padded arrays
    std::array<Real, 3> place;  ///< spacings, (x, y, 0)
    Real weight, share;
  };
  /// What an owned column is to a node.
  struct Place {
    std::size_t node, member;
  };

  /// Values of a node: a row before the owned ones, these, and at least one after them; whole vectors fit in.
  std::size_t stride() const { return static_cast<std::size_t>((domain_->blocks() + 1) * block_rows); }
  std::size_t index(std::size_t node, std::int64_t row) const {
    return node * stride() + static_cast<std::size_t>(row + 1);
  }
  Vectors make_vectors(std::size_t nodes) const {
    const std::vector<Real> component(nodes * stride());
    return {component, component, component};
  }

  /// Calls `use(weight, share)` with functions of how far the first row of a vector is behind `row`.
  template <class Use>
  void with_weights(std::size_t member, std::int64_t row, const Use& use) const {
    if (row_weights_.empty()) {
      use([w = X(members_[member].weight)](std::size_t) { return w; },
          [s = X(members_[member].share)](std::size_t) { return s; });
    } else {
      const std::size_t first = index(member, row);
      use([w = row_weights_.data() + first](std::size_t i) { return X::load(w + i); },
          [s = row_shares_.data() + first](std::size_t i) { return X::load(s + i); });
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
    const double spacing = setup_->lattice.spacing;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      nodes_[n].first_member = members_.size();
      for (const LumenSurface::Member& m : surface.of(nodes_[n].global)) {
        const auto c = static_cast<std::size_t>(m.column);
        if (n < own_nodes_ && owned(m))
          places[static_cast<std::size_t>(m.column - l.first_column)].push_back({n, members_.size()});
        members_.push_back({.values = domain_->padded(domain_->slot(m.column)),
                            .place = {Real(section.x[c] / spacing), Real(section.y[c] / spacing), 0},
                            .weight = Real(m.weight),
                            .share = Real(m.share)});
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
    std::size_t first = 0;  // of a node's members
    for (const Node& node : nodes_) {
      const auto members = setup_->lumen.of(node.global);
      for (std::int64_t row = -1; row <= domain_->layout().row_count; ++row) {
        const double z = setup_->lattice.height((domain_->layout().first_row + row + rows) % rows);
        const auto [shares, weights] = shares_and_weights(members, z);
        for (std::size_t j = 0; j < members.size(); ++j) {
          row_shares_[index(first + j, row)] = static_cast<Real>(shares[j]);
          row_weights_[index(first + j, row)] = static_cast<Real>(weights[j]);
        }
      }
      first += members.size();
    }
  }

  std::pair<std::vector<double>, std::vector<double>> shares_and_weights(
      std::span<const LumenSurface::Member> members, double z) const {
    const CrossSection& section = setup_->lattice.section;
    std::vector<std::array<double, 2>> points;
    std::vector<double> shares;
    double total = 0;
    for (const LumenSurface::Member& m : members) {
      const auto c = static_cast<std::size_t>(m.column);
      points.push_back({section.x[c], section.y[c]});
      shares.push_back(m.share * setup_->thin_spots.load_share(section.x[c], section.y[c], z));
      total += shares.back();
    }
    for (double& share : shares) share /= total;
    return {shares, extrapolation_weights(points, shares, setup_->inner_radius)};
  }

  template <bool wrapped>
  void find_all(std::array<const Real*, 3> u) {
    parallel::for_each_share(threads_, nodes_.size(), [&](int, std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) find_place<wrapped>(n, u);
    });
    parallel::for_each_share(threads_, own_nodes_, [&](int, std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        find_depth<wrapped>(n, u);
        find_node_forces<wrapped>(n);
      }
    });
  }

  /// The difference of two displacements that are known up to whole periods where they are wrapped.
  template <bool wrapped>
  static HWY_INLINE X apart(X there, X here) {
    const X difference = there - here;
    if constexpr (!wrapped) return difference;
    return difference - round(difference * Real(1 / wrap_period)) * Real(wrap_period);
  }

  /// Displacement of a node in all rows, as a mean of its members'.
  template <bool wrapped>
  void find_place(std::size_t n, std::array<const Real*, 3> u) {
    const ColumnLayout& l = domain_->layout();
    const auto count = static_cast<std::size_t>(l.row_count) + 2;
    const std::size_t first = nodes_[n].first_member;
    for (std::size_t k = 0; k < 3; ++k) {
      Real* const out = place_[k].data() + index(n, -1);
      const Real* const of_first = u[k] + members_[first].values - 1;
      std::copy_n(of_first, stride(), out);
      for (std::size_t m = first + 1; m < nodes_[n].past_member; ++m) {
        const Real* const in = u[k] + members_[m].values - 1;
        with_weights(m, -1, [&](const auto& weight, const auto&) {
          for (std::size_t i = 0; i < count; i += lanes())
            (X::load(out + i) + weight(i) * apart<wrapped>(X::load(in + i), X::load(of_first + i)))
                .store(out + i);
        });
      }
      if (domain_->periodic()) continue;
      const bool one = l.rows == 1;
      if (l.first_row == 0) out[0] = one ? out[1] : 2 * out[1] - out[2];
      if (l.first_row + l.row_count == l.rows)
        out[count - 1] = one ? out[count - 2] : 2 * out[count - 2] - out[count - 3];
    }
  }

  /// Puts the way from an own node to the mean of its layer into `spread_`.
  template <bool wrapped>
  void find_depth(std::size_t n, std::array<const Real*, 3> u) {
    const auto rows = static_cast<std::size_t>(domain_->layout().row_count);
    const std::size_t first = nodes_[n].first_member;
    for (std::size_t k = 0; k < 3; ++k) {
      Real* const out = spread_[k].data() + index(n, 0);
      const Real* const of_first = u[k] + members_[first].values;
      std::fill_n(out, stride() - block_rows, Real{0});
      for (std::size_t m = first + 1; m < nodes_[n].past_member; ++m) {
        const Real* const in = u[k] + members_[m].values;
        const X place = members_[m].place[k] - members_[first].place[k];
        with_weights(m, 0, [&](const auto& weight, const auto& share) {
          for (std::size_t i = 0; i < rows; i += lanes()) {
            const X way = place + apart<wrapped>(X::load(in + i), X::load(of_first + i));
            (X::load(out + i) + (share(i) - weight(i)) * way).store(out + i);
          }
        });
      }
    }
  }

  /// A patch as seen from one of its nodes: `p` and `q` lead along its edges to neighbours, anticlockwise as
  /// seen from outside the wall, `pq` to the node across.
  struct Patch {
    Vector p, q, pq;

    /// 1; 0 where an edge along p or q is longer than allowed (squares of lengths).
    HWY_INLINE X present(X longest_p, X longest_q) const {
      const X along_p = max(p.squared(), (pq - q).squared()), along_q = max(q.squared(), (pq - p).squared());
      return where(along_p < longest_p, where(along_q < longest_q, X(Real{1})));
    }
    /// 12 times the node's share of the vector area: the integral of its shape function over the normals of
    /// the bilinear patch.
    HWY_INLINE Vector area() const {
      const Vector d = p - q;
      return {(p.y * q.z - p.z * q.y) + (d.y * pq.z - d.z * pq.y),
              (p.z * q.x - p.x * q.z) + (d.z * pq.x - d.x * pq.z),
              (p.x * q.y - p.y * q.x) + (d.x * pq.y - d.y * pq.x)};
    }
  };

  /// The sum over a node's patches that are not torn.
  struct NodeArea {
    X patches = Real{0};                     ///< how many
    Vector area{Real{0}, Real{0}, Real{0}};  ///< 12 times the vector area

    HWY_INLINE void add(const Patch& patch, X longest_p, X longest_q) {
      const X present = patch.present(longest_p, longest_q);
      const Vector a = patch.area();
      patches = patches + present;
      area = {area.x + present * a.x, area.y + present * a.y, area.z + present * a.z};
    }
  };

  static HWY_INLINE Vector vector_at(const Real* const (&u)[3], std::size_t i) {
    return {X::load(u[0] + i), X::load(u[1] + i), X::load(u[2] + i)};
  }
  /// The way between nodes that are displaced by `here` and `there`, `edge` and `up` apart in the undeformed
  /// wall.
  template <bool wrapped>
  static HWY_INLINE Vector way(const Vector& here, const Vector& there, const std::array<Real, 3>& edge,
                               Real up) {
    return {X(edge[0]) + apart<wrapped>(there.x, here.x), X(edge[1]) + apart<wrapped>(there.y, here.y),
            X(up) + apart<wrapped>(there.z, here.z)};
  }

  /// Makes `area_` and `spread_` of an own node.
  template <bool wrapped>
  void find_node_forces(std::size_t n) {
    const LumenSurface& surface = setup_->lumen;
    const Node& node = nodes_[n];
    const double spacing = setup_->lattice.spacing;
    const auto chord = [&](std::int32_t to) {
      const auto& a = surface.nodes[static_cast<std::size_t>(node.global)];
      const auto& b = surface.nodes[static_cast<std::size_t>(to)];
      return std::array{Real((b[0] - a[0]) / spacing), Real((b[1] - a[1]) / spacing), Real{0}};
    };
    const std::array<Real, 3> none{}, forth = chord(surface.next(node.global)),
                                      back = chord(surface.previous(node.global));
    const Real rise = Real(setup_->lattice.row_spacing / spacing);
    const auto longest = [&](const std::array<Real, 3>& edge, Real up) {
      return X(Real(longest_stretch_ * longest_stretch_) * (edge[0] * edge[0] + edge[1] * edge[1] + up * up));
    };
    const X longest_forth = longest(forth, 0), longest_back = longest(back, 0),
            longest_rise = longest(none, rise);
    const X factor = Real(surface.area_factor / 12);
    const std::array<double, 2> undeformed = surface.undeformed_area(node.global);
    const X quarter_area = Real(0.25 * rise * std::hypot(undeformed[0], undeformed[1]) / spacing);
    const std::size_t to_next = (node.next - n) * stride(), to_previous = (node.previous - n) * stride();
    const Real* const u[3] = {place_[0].data(), place_[1].data(), place_[2].data()};

    const std::size_t first = index(n, 0), past = index(n, domain_->layout().row_count);
    for (std::size_t i = first; i < past; i += lanes()) {
      const Vector here = vector_at(u, i);
      const std::size_t e = i + to_next, w = i + to_previous;
      const Vector east = way<wrapped>(here, vector_at(u, e), forth, 0),
                   west = way<wrapped>(here, vector_at(u, w), back, 0),
                   north = way<wrapped>(here, vector_at(u, i + 1), none, rise),
                   south = way<wrapped>(here, vector_at(u, i - 1), none, -rise);
      NodeArea node_area;
      node_area.add({east, north, way<wrapped>(here, vector_at(u, e + 1), forth, rise)}, longest_forth,
                    longest_rise);
      node_area.add({north, west, way<wrapped>(here, vector_at(u, w + 1), back, rise)}, longest_rise,
                    longest_back);
      node_area.add({west, south, way<wrapped>(here, vector_at(u, w - 1), back, -rise)}, longest_back,
                    longest_rise);
      node_area.add({south, east, way<wrapped>(here, vector_at(u, e - 1), forth, -rise)}, longest_rise,
                    longest_forth);
      const Vector depth{X::load(&spread_[0][i]), X::load(&spread_[1][i]), X::load(&spread_[2][i])};
      const X shallowest = Real(1e-30);  // of no depth, where a layer has one radius
      const X spread = quarter_area * node_area.patches / sqrt(max(depth.squared(), shallowest));
      const X spreads[3] = {spread * depth.x, spread * depth.y, spread * depth.z},
              areas[3] = {node_area.area.x, node_area.area.y, node_area.area.z};
      for (std::size_t k = 0; k < 3; ++k) {
        spreads[k].store(&spread_[k][i]);
        (factor * areas[k] - spreads[k]).store(&area_[k][i]);
      }
    }
  }

  const BodySetup* setup_;
  const Domain* domain_;
  int threads_;
  double longest_stretch_ = 1;  ///< of an edge that is not torn
  std::vector<Node> nodes_;     ///< own nodes, then neighbours of theirs
  std::size_t own_nodes_ = 0;
  std::vector<Member> members_;
  std::vector<Real> row_weights_, row_shares_;  ///< [members][stride()]; empty: the same in all rows
  std::vector<Place> places_;
  std::vector<std::size_t> first_place_;  ///< [owned columns + 1]
  Vectors place_;                         ///< spacings, displacement of nodes
  Vectors area_, spread_;                 ///< square spacings, of own nodes: A - A0 d/|d| and A0 d/|d|
  std::vector<std::uint16_t> loose_;      ///< [blocks] rows without an intact bond, of loaded columns
};

}  // namespace rhexis::peridynamics
