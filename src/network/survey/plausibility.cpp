// SPDX-License-Identifier: BSD-3-Clause
#include "network/survey/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/faults.hpp"
#include "core/format.hpp"
#include "network/connectivity.hpp"
#include "network/disjoint_sets.hpp"

namespace rhexis::network {
namespace {

constexpr double widest = 0.03, narrowest = 1e-6;             ///< m, radii
constexpr double least_share_of_distance = 0.05;              ///< of a length
constexpr double rounding_of_lengths = 0.01;                  ///< relative
constexpr double many_short_branches = 0.1;                   ///< share of all branches
constexpr double capillary_radius = 10e-6;                    ///< m
constexpr double capillary_pressure = 80 * pascals_per_mmhg;  ///< Pa

/// Items that are improbable alike, of which the first is told.
struct Tally {
  std::size_t count = 0, first = 0;
  void add(std::size_t item) {
    if (count++ == 0) first = item;
  }
};

/// Looks at a network once.
class Look {
 public:
  explicit Look(const BoundedGraph& network) : network_(network), g_(network.graph), degree_(degrees(g_)) {}

  Improbable found() {
    for (std::size_t v = 0; v < g_.vessels(); ++v) look_at_vessel(v);
    look_at_branches();
    look_at_conditions();
    faults_.raise();
    tell_radii();
    tell_lengths();
    tell_pressures();
    return std::move(found_);
  }

 private:
  void look_at_vessel(std::size_t v) {
    if (g_.radius[v] > widest) wide_.add(v);
    if (g_.radius[v] < narrowest) narrow_.add(v);
    if (g_.x.empty()) return;
    const double distance = distance_of_ends(v);
    if (g_.length[v] < least_share_of_distance * distance) {
      faults_.add(fmt::format("{}: length {}, but its ends are {} apart: is a unit wrong?",
                              network_.place_of_vessel(v), quantity(g_.length[v], "m"),
                              quantity(distance, "m")));
    } else if (g_.length[v] < (1 - rounding_of_lengths) * distance) {
      shorter_than_drawn_.add(v);
    }
  }

  /// Vessels that continue each other, where no other one meets them, are a branch, whose pieces may be
  /// short.
  void look_at_branches() {
    DisjointSets branch(g_.vessels());
    constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint32_t> met(g_.junctions, none);
    for (std::uint32_t v = 0; v < g_.vessels(); ++v) {
      for (const std::uint32_t j : {g_.from[v], g_.to[v]}) {
        if (degree_[j] != 2) continue;
        if (met[j] != none) branch.join(met[j], v);
        met[j] = v;
      }
    }
    std::vector<double> length(g_.vessels());
    for (std::uint32_t v = 0; v < g_.vessels(); ++v) length[branch.of(v)] += g_.length[v];
    for (std::uint32_t v = 0; v < g_.vessels(); ++v) {
      if (branch.of(v) != v) continue;
      ++branches_;
      if (length[v] < g_.radius[v]) short_.add(v);
    }
  }

  double distance_of_ends(std::size_t v) const {
    const std::uint32_t a = g_.from[v], b = g_.to[v];
    return std::hypot(g_.x[a] - g_.x[b], g_.y[a] - g_.y[b], g_.z[a] - g_.z[b]);
  }

  void look_at_conditions() {
    std::vector<double> radius(g_.junctions);  // of the widest vessel
    for (std::size_t v = 0; v < g_.vessels(); ++v)
      for (const std::uint32_t j : {g_.from[v], g_.to[v]}) radius[j] = std::max(radius[j], g_.radius[v]);
    for (std::size_t i = 0; i < network_.conditions.size(); ++i) {
      const BoundaryCondition& c = network_.conditions[i];
      const bool is_pressure = c.kind == BoundaryCondition::Kind::pressure && c.resistance == 0;
      if (is_pressure && c.value > capillary_pressure && radius[c.junction] < capillary_radius)
        arterial_.add(i);
    }
  }

  static std::string others(const Tally& tally) {
    return tally.count > 1 ? fmt::format(", the first of {}", grouped(static_cast<long long>(tally.count)))
                           : "";
  }

  std::string sentence(const Tally& tally, const std::string& what) const {
    return fmt::format("{}{}: {}", network_.place_of_vessel(tally.first), others(tally), what);
  }

  void tell_radii() {
    const auto warn = [&](const Tally& tally, double limit, const char* what) {
      if (tally.count == 0) return;
      found_.warnings.push_back(
          sentence(tally, fmt::format("radius {}, {} {}: is the unit right?",
                                      quantity(g_.radius[tally.first], "m"), what, quantity(limit, "m"))));
    };
    warn(wide_, widest, "wider than any vessel, above");
    warn(narrow_, narrowest, "narrower than capillaries, below");
  }

  void tell_lengths() {
    if (shorter_than_drawn_.count > 0) {
      const std::size_t v = shorter_than_drawn_.first;
      found_.notes.push_back(
          sentence(shorter_than_drawn_,
                   fmt::format("length {}, but its ends are {} apart: are the coordinates a sketch?",
                               quantity(g_.length[v], "m"), quantity(distance_of_ends(v), "m"))));
    }
    if (static_cast<double>(short_.count) <= many_short_branches * static_cast<double>(branches_)) return;
    found_.warnings.push_back(sentence(
        short_, fmt::format("length {}, below the radius, {}: are the units right?",
                            quantity(g_.length[short_.first], "m"), quantity(g_.radius[short_.first], "m"))));
  }

  void tell_pressures() {
    if (arterial_.count == 0) return;
    const BoundaryCondition& c = network_.conditions[arterial_.first];
    found_.warnings.push_back(fmt::format(
        "junction {}{}: {} at the end of a vessel narrower than {}, where blood has less: is the unit of "
        "lengths right?",
        g_.name_of_junction(c.junction), others(arterial_), mmhg(c.value),
        quantity(2 * capillary_radius, "m")));
  }

  const BoundedGraph& network_;
  const Graph& g_;
  std::vector<std::uint32_t> degree_;  ///< [J] vessels of a junction
  std::size_t branches_ = 0;
  Tally wide_, narrow_, short_, shorter_than_drawn_;  ///< vessels
  Tally arterial_;                                    ///< numbers of conditions
  Faults faults_;
  Improbable found_;
};

}  // namespace

Improbable improbable(const BoundedGraph& network) {
  return Look(network).found();
}

}  // namespace rhexis::network
