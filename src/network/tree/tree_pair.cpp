// SPDX-License-Identifier: BSD-3-Clause
#include "network/tree/tree_pair.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "network/tree/random_stream.hpp"

namespace rhexis::network {
namespace {

constexpr std::string_view artery_prefix = "artery.", vein_prefix = "vein.";

/// Murray's angle between a parent (radius r0) and its daughter r1, whose sister is r2, for the least volume:
/// cos = (r0^4 + r1^4 - r2^4) / (2 r0^2 r1^2). At least 0 where the rule has no solution (xi < 2), at most 80
/// degrees, so that every vessel comes nearer to the midplane.
double murray_cosine(double r0, double r1, double r2) {
  const double p = r0 * r0, q = r1 * r1, s = r2 * r2;
  return std::clamp((p * p + q * q - s * s) / (2 * p * q), 0.17, 1.0);
}

}  // namespace

TreePair::TreePair(TreeRules rules) : rules_(std::move(rules)) {
  least_offset_ = rules_.wider_share(rules_.asymmetry) - 0.5;
  most_offset_ = rules_.random_splits() ? rules_.wider_share(rules_.least_asymmetry) - 0.5 : least_offset_;
  const long double root = rules_.root_radius, power = 1 / static_cast<long double>(rules_.exponent);
  radius_ = IntervalTable([=](long double a) { return root * std::pow(a, power); }, least_capacity(), 1);
  // Along the axis, a symmetric subtree reaches its root's length and what its daughters reach.
  const double ratio = std::pow(0.5, 1 / rules_.exponent);
  const double cosine = murray_cosine(1, ratio, ratio);
  const int k = generations();
  reach_per_radius_.assign(static_cast<std::size_t>(k) + 1, 0.0);
  for (int g = k - 1; g >= 0; --g) {
    const double radius = rules_.root_radius * std::pow(ratio, g);
    const auto at = static_cast<std::size_t>(g);
    reach_per_radius_[at] =
        (g == 0 ? 1.0 : cosine) * rules_.length(g, radius) / radius + ratio * reach_per_radius_[at + 1];
  }
  reach_ = reach_per_radius_[0] * rules_.root_radius;
}

int TreePair::generation_of(std::uint64_t place) {
  return static_cast<int>(std::bit_width(place)) - 1;
}

std::string TreePair::path_of(std::uint64_t id) {
  const std::uint64_t place = place_of(id);
  std::string path(kind_of(id) == VesselKind::artery ? artery_prefix : vein_prefix);
  for (int bit = generation_of(place) - 1; bit >= 0; --bit) path += (place >> bit & 1) != 0 ? '1' : '0';
  return path;
}

std::uint64_t TreePair::id_of(std::string_view path, int generations) {
  const auto refuse = [&](const std::string& why) -> std::uint64_t {
    throw InputError("there is no vessel '" + std::string(path) + "' in this tree: " + why);
  };
  std::uint64_t id = 0;
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), id);
  if (error == std::errc() && end == path.data() + path.size()) {
    if (id >= vessels_of(generations))
      return refuse("ids run from 0 to " + std::to_string(vessels_of(generations) - 1));
    return id;
  }
  const bool vein = path.starts_with(vein_prefix);
  if (!vein && !path.starts_with(artery_prefix)) {
    return refuse("a vessel is a number or a path such as \"artery.\" (the root) or \"vein.011\"");
  }
  const std::string_view steps = path.substr(vein ? vein_prefix.size() : artery_prefix.size());
  if (steps.size() >= static_cast<std::size_t>(generations)) {
    return refuse("a path has at most " + std::to_string(generations - 1) + " steps");
  }
  std::uint64_t place = 1;
  for (const char step : steps) {
    if (step != '0' && step != '1') return refuse("a path is made of 0 and 1");
    place = 2 * place + (step == '1');
  }
  return id_of(place, vein ? VesselKind::vein : VesselKind::artery);
}

double TreePair::first_share(std::uint64_t place) const {
  if (!rules_.random_splits()) return 0.5 + least_offset_;
  const std::uint32_t bits = draw(rules_.seed, Stream::splits, place);
  const double offset = least_offset_ + (most_offset_ - least_offset_) * even_share(bits);
  return coin(bits) ? 0.5 - offset : 0.5 + offset;
}

double TreePair::capacity(std::uint64_t place) const {
  double capacity = 1;
  for (int bit = generation_of(place) - 1; bit >= 0; --bit) {
    const double first = capacity * first_share(place >> (bit + 1));
    capacity = (place >> bit & 1) != 0 ? capacity - first : first;
  }
  return capacity;
}

double TreePair::least_capacity() const {
  return std::pow(0.5 - most_offset_, generations() - 1) *
         (1 - 1e-6);  // a margin for roundings on the way down
}

double TreePair::length_factor(std::uint64_t place) const {
  if (!rules_.random_lengths()) return 1;
  const std::uint32_t bits = draw(rules_.seed, Stream::lengths, place);
  return 1 - rules_.length_spread + 2 * rules_.length_spread * even_share(bits);
}

TreePair::Place TreePair::root_place() const {
  const double length = rules_.length(0, rules_.root_radius) * length_factor(1);
  const double share = advance_share(0, rules_.root_radius, length, 1);
  return {1, {share == 1 ? 0.0 : -reach_ * (1 - share), 0, 0}};
}

/// Part of what is left to the midplane that a vessel covers: its own advance along the axis over that and
/// what a symmetric subtree would still reach. 1 in the last generation.
double TreePair::advance_share(int generation, double radius, double length, double cosine) const {
  const double ratio = std::pow(0.5, 1 / rules_.exponent);
  const double own = length * cosine;
  return own / (own + ratio * radius * reach_per_radius_[static_cast<std::size_t>(generation) + 1]);
}

std::array<TreePair::Place, 2> TreePair::daughters(std::uint64_t place, const Place& at) const {
  const double first = at.capacity * first_share(place);
  const std::array<double, 2> capacity{first, at.capacity - first};
  const double parent = radius_of(at.capacity);
  const std::array<double, 2> radius{radius_of(capacity[0]), radius_of(capacity[1])};
  const int generation = generation_of(place) + 1;
  const bool last = generation == generations() - 1;
  const std::size_t sideways = rules_.layout == TreeLayout::planar || generation % 2 == 1 ? 1 : 2;
  // The first daughter goes left or right by the parity of its parent's path, so that no side is preferred.
  const double side = std::popcount(place) % 2 == 1 ? 1 : -1;
  std::array<Place, 2> places;
  for (std::size_t i = 0; i < 2; ++i) {
    const double cosine = murray_cosine(parent, radius[i], radius[1 - i]);
    const double length = rules_.length(generation, radius[i]) * length_factor(2 * place + i);
    const double advance = -at.end[0] * (last ? 1.0 : advance_share(generation, radius[i], length, cosine));
    places[i].capacity = capacity[i];
    places[i].end = at.end;
    places[i].end[0] = last ? 0.0 : at.end[0] + advance;
    const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
    places[i].end[sideways] += (i == 0 ? side : -side) * advance * tangent;
  }
  return places;
}

TreeVessel TreePair::vessel(std::uint64_t id) const {
  if (id >= vessels()) {
    throw InputError("there is no vessel " + std::to_string(id) + "; ids run from 0 to " +
                     std::to_string(vessels() - 1));
  }
  const std::uint64_t place = place_of(id);
  Point start = inlet();
  Place at = root_place();
  for (int bit = generation_of(place) - 1; bit >= 0; --bit) {
    start = at.end;
    at = daughters(place >> (bit + 1), at)[place >> bit & 1];
  }
  TreeVessel v;
  v.id = id;
  v.kind = kind_of(id);
  v.generation = generation_of(place);
  const bool artery = v.kind == VesselKind::artery;
  const double arterial = radius_of(at.capacity);
  v.radius = artery ? arterial : arterial * rules_.vein_radius_ratio;
  v.length = rules_.length(v.generation, arterial) * length_factor(place);
  v.wall_thickness = v.radius * (artery ? rules_.artery_wall : rules_.vein_wall).relative_thickness(v.radius);
  v.start = artery ? start : mirrored(at.end);
  v.end = artery ? at.end : mirrored(start);
  const std::uint64_t outlet = std::uint64_t{1} << generations(), first_last = outlet >> 1;
  const std::uint64_t far_vein = place >= first_last ? place : outlet + place;
  const std::uint64_t near_artery = place / 2, near_vein = outlet + place / 2;
  v.from = artery ? near_artery : far_vein;
  v.to = artery ? place : near_vein;
  return v;
}

}  // namespace rhexis::network
