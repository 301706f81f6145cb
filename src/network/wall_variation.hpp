// SPDX-License-Identifier: BSD-3-Clause
/// Walls that differ from their rule: vessels marked as weak, and scatter from vessel to vessel.
///
/// A vessel has a *number* among those of its kind: its place in a tree (network/tree/tree_pair.hpp), its index in
/// a graph. Scatter is drawn from a counter-based stream by that number, so it does not depend on who asks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/lognormal.hpp"
#include "core/parameter.hpp"
#include "network/graph.hpp"
#include "network/interval_table.hpp"
#include "network/tree/random_stream.hpp"

namespace rhexis::network {

/// The input keys of [weakness].
struct WeaknessParameters {
  std::vector<std::string> vessels, subtrees;
  double strength = 0.5, thickness = 1;
  double strength_spread = 0, thickness_spread = 0;
  std::int64_t seed = 0;
};

ParameterList declare(WeaknessParameters& p);

/// What a wall's critical stretch and thickness are multiplied by.
struct WallFactors {
  double strength = 1, thickness = 1;
};

/// A lognormal factor of mean 1, one draw a vessel, tabulated.
class FactorStream {
 public:
  FactorStream() = default;
  FactorStream(double spread, std::uint64_t seed, Stream first);

  bool varies() const { return varies_; }
  double operator()(VesselKind kind, std::uint64_t number) const {
    if (!varies_) return 1;
    const std::uint32_t bits = draw(seed_, stream(kind), number);
    const double below = lower_(even_share(bits) / 2);
    return coin(bits) ? product_ / below : below;
  }

  /// For the vector code: a draw is `lower` of half the even share, or `product` over that where the coin is
  /// true.
  const IntervalTable& lower() const { return lower_; }
  double product() const { return product_; }
  std::uint64_t seed() const { return seed_; }
  Stream stream(VesselKind kind) const {
    return static_cast<Stream>(static_cast<std::uint32_t>(first_) + (kind == VesselKind::vein ? 1 : 0));
  }

 private:
  bool varies_ = false;
  std::uint64_t seed_ = 0;
  Stream first_ = Stream::wall_strength;
  IntervalTable lower_;
  double product_ = 1;
};

class WallVariation {
 public:
  /// Numbers [first, past) of one kind.
  struct Range {
    std::uint64_t first, past;
  };

  /// All walls by the rule.
  WallVariation() = default;
  /// Nothing is marked yet.
  explicit WallVariation(const WeaknessParameters& p);

  void mark(VesselKind kind, std::vector<Range> numbers);
  /// Marks `vessels` and `subtrees` of a tree. Throws InputError, with its key, for a path that does not
  /// exist.
  void mark_in_tree(const WeaknessParameters& p, int generations);

  WallFactors of(VesselKind kind, std::uint64_t number) const;
  bool marked(VesselKind kind, std::uint64_t number) const;
  /// The marked numbers within [first, past), ascending and apart.
  std::vector<Range> marked_in(VesselKind kind, std::uint64_t first, std::uint64_t past) const;
  bool varies() const { return strength_.varies() || thickness_.varies(); }  ///< from vessel to vessel
  const FactorStream& strength() const { return strength_; }
  const FactorStream& thickness() const { return thickness_; }

 private:
  static std::size_t side(VesselKind kind) { return kind == VesselKind::vein ? 1 : 0; }

  FactorStream strength_, thickness_;
  WallFactors weak_;
  std::vector<Range> marks_[2];  ///< ascending and apart; arteries and all that are not veins, veins
};

}  // namespace rhexis::network
