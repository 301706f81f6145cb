// SPDX-License-Identifier: BSD-3-Clause
/// An arterial tree and its venous mirror by formula, without a solver. Counts what it is asked for.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/field_view.hpp"

namespace rhexis::test {

/// Two bifurcating trees that meet at the midplane x = 0: arteries at x < 0, veins at x > 0; the first vessel
/// of each has a radius of 12.5 mm, each generation 0.79 of the one before, lengths of about 15 to 25 radii.
/// Vessels are dealt out to ranks in blocks, each with end points of its own.
class SyntheticNetwork : public LineSource {
 public:
  /// `kind`: words between colons, of which "spatial" (else planar), "unknown" (nobody knows what is an
  /// artery) and a number (of generations) mean something.
  SyntheticNetwork(const std::string& kind, int rank, int ranks) {
    const bool spatial = kind.find("spatial") != std::string::npos;
    known_ = kind.find("unknown") == std::string::npos;
    int generations = 4;
    const std::size_t last = kind.rfind(':');
    if (last != std::string::npos && std::isdigit(kind[last + 1]))
      generations = std::stoi(kind.substr(last + 1));
    double reach = 0;
    for (int g = 0; g < generations; ++g) reach += length_of(g);
    std::vector<Vessel> all;
    for (const double side : {-1.0, 1.0}) grow(all, {side, spatial, generations}, {-reach, 0, 0}, 0, 0);
    total_ = all.size();
    const auto part = [&](int of) {
      return total_ * static_cast<std::size_t>(of) / static_cast<std::size_t>(ranks);
    };
    for (std::size_t v = part(rank); v < part(rank + 1); ++v) add(all[v]);
  }

  /// Moves on in time (`progress` 0 ... 1); the network itself stays as it is.
  void advance(long step, double progress) {
    step_ = step;
    progress_ = progress;
  }

  long step() const override { return step_; }
  double time_s() const override { return 2.5e-3 * progress_; }
  std::span<const FieldInfo> fields() const override { return field_infos; }
  std::span<const std::int64_t> connectivity() override { return ends_; }
  std::vector<Annotation> annotations() const override {
    return {{"vessels", "1", 34359738366.0},
            {"shown", "1", static_cast<double>(total_)},
            {"inflow", "m3/s", inflow}};
  }

  FieldView positions() override {
    return {{"position", "m", 3},
            {position_[0].data(), position_[1].data(), position_[2].data()},
            position_[0].size()};
  }

  FieldView field(std::string_view name) override {
    for (const FieldInfo& info : field_infos) {
      if (info.name != name) continue;
      ++asked[std::string(name)];
      const std::vector<double>& values = values_[std::string(name)];
      return {info, {values.data()}, values.size()};
    }
    throw std::out_of_range(std::string(name));
  }

  std::map<std::string, int> asked;  ///< calls of `field` by name

 private:
  static constexpr double inflow = 5e-3 / 60, highest = 13332, middle = 4000, lowest = 667;
  static constexpr FieldInfo field_infos[] = {{"pressure", "Pa", 1},
                                              {"flow", "m3/s", 1, Centring::cell},
                                              {"radius", "m", 1, Centring::cell},
                                              {"generation", "1", 1, Centring::cell},
                                              {"kind", "1", 1, Centring::cell},
                                              {"wall_shear_stress", "Pa", 1, Centring::cell},
                                              {"hoop_strain", "1", 1, Centring::cell}};
  using Point = std::array<double, 3>;

  struct Tree {
    double side;  ///< -1: arteries, 1: veins
    bool spatial;
    int generations;
  };

  struct Vessel {
    Point from, to;
    int generation;
    bool vein;
    double share_from, share_to;  ///< of the pressure drop of the tree
  };

  static double radius_of(int generation) { return 12.5e-3 * std::pow(0.79, generation); }
  static double length_of(int generation) {
    return (20 + 4 * std::cos(2.0 * generation)) * radius_of(generation);
  }

  static void grow(std::vector<Vessel>& all, const Tree& tree, const Point& from, int generation,
                   int branch) {
    Point to = from;
    to[0] += length_of(generation);
    const std::size_t sideways = tree.spatial && generation % 2 == 1 ? 2 : 1;
    const int halvings = tree.spatial ? (generation - 1) / 2 : generation - 1;
    if (generation > 0) to[sideways] += (branch == 0 ? -1 : 1) * 0.24 * std::pow(0.5, halvings);
    const auto mirrored = [&](Point p) { return Point{-tree.side * p[0], p[1], p[2]}; };
    const auto share = [&](int g) { return static_cast<double>(g) / tree.generations; };
    all.push_back(
        {mirrored(from), mirrored(to), generation, tree.side > 0, share(generation), share(generation + 1)});
    if (generation + 1 == tree.generations) return;
    for (const int child : {0, 1}) grow(all, tree, to, generation + 1, child);
  }

  void add(const Vessel& vessel) {
    const double radius = radius_of(vessel.generation);
    const double flow = inflow * std::pow(0.5, vessel.generation);
    for (const auto& [point, share] :
         {std::pair{vessel.from, vessel.share_from}, {vessel.to, vessel.share_to}}) {
      ends_.push_back(static_cast<std::int64_t>(position_[0].size()));
      for (std::size_t c = 0; c < 3; ++c) position_[c].push_back(point[c]);
      values_["pressure"].push_back(vessel.vein ? lowest + (middle - lowest) * share
                                                : highest + (middle - highest) * share);
    }
    values_["flow"].push_back(flow);
    values_["radius"].push_back(radius);
    values_["generation"].push_back(vessel.generation);
    values_["kind"].push_back(!known_ ? 2 : vessel.vein ? 1 : 0);
    values_["wall_shear_stress"].push_back(4 * 3.5e-3 * flow / (std::numbers::pi * std::pow(radius, 3)));
    values_["hoop_strain"].push_back(0.05);
  }

  bool known_ = true;
  std::size_t total_ = 0;
  long step_ = 0;
  double progress_ = 0;
  std::array<std::vector<double>, 3> position_;
  std::vector<std::int64_t> ends_;
  std::map<std::string, std::vector<double>> values_;
};

}  // namespace rhexis::test
