// SPDX-License-Identifier: BSD-3-Clause
#include "network/wall_variation.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "network/tree/tree_pair.hpp"

namespace rhexis::network {

ParameterList declare(WeaknessParameters& p) {
  const std::vector<Condition> some_are_weak{{"weakness.vessels", {}}, {"weakness.subtrees", {}}};
  return {
      {.key = "weakness.vessels",
       .target = &p.vessels,
       .meaning =
           "Vessels with a weak wall: ids, or in a tree paths such as \"artery.0110\"; in a file its names."},
      {.key = "weakness.subtrees",
       .target = &p.subtrees,
       .meaning = "Regions with weak walls: the path of a vessel of a tree, which is weak with all of its "
                  "kind below it."},
      {.key = "weakness.strength",
       .target = &p.strength,
       .unit = "1",
       .meaning = "Critical stretch of weak walls over that of the others.",
       .range = Range::positive(),
       .only_with = some_are_weak},
      {.key = "weakness.thickness",
       .target = &p.thickness,
       .unit = "1",
       .meaning = "Thickness of weak walls over that of the others.",
       .range = Range::positive(),
       .only_with = some_are_weak},
      {.key = "weakness.strength_spread",
       .target = &p.strength_spread,
       .unit = "1",
       .meaning = "Scatter of critical stretch from vessel to vessel: coefficient of variation of a "
                  "lognormal factor of mean 1.",
       .range = Range::between(0, 1)},
      {.key = "weakness.thickness_spread",
       .target = &p.thickness_spread,
       .unit = "1",
       .meaning = "The same of wall thickness.",
       .range = Range::between(0, 1)},
      {.key = "weakness.seed",
       .target = &p.seed,
       .unit = "1",
       .meaning = "Which walls are drawn.",
       .range = Range::at_least(0),
       .only_with = {{"weakness.strength_spread", {}}, {"weakness.thickness_spread", {}}}},
  };
}

FactorStream::FactorStream(double spread, std::uint64_t seed, Stream first)
    : varies_(spread > 0), seed_(seed), first_(first) {
  if (!varies_) return;
  const Lognormal factor(spread);
  // Half of even_share is never below 2^-33.
  lower_ = IntervalTable([=](long double share) { return factor.lower(share); }, 0x1p-33, 0.5);
  product_ = factor.upper_of(1.0);
}

WallVariation::WallVariation(const WeaknessParameters& p)
    : strength_(p.strength_spread, static_cast<std::uint64_t>(p.seed), Stream::wall_strength),
      thickness_(p.thickness_spread, static_cast<std::uint64_t>(p.seed), Stream::wall_thickness),
      weak_{p.strength, p.thickness} {}

void WallVariation::mark(VesselKind kind, std::vector<Range> numbers) {
  numbers.insert(numbers.end(), marks_[side(kind)].begin(), marks_[side(kind)].end());
  std::sort(numbers.begin(), numbers.end(), [](const Range& a, const Range& b) { return a.first < b.first; });
  std::vector<Range> apart;
  for (const Range& range : numbers) {
    if (!apart.empty() && range.first <= apart.back().past) {
      apart.back().past = std::max(apart.back().past, range.past);
    } else {
      apart.push_back(range);
    }
  }
  marks_[side(kind)] = std::move(apart);
}

void WallVariation::mark_in_tree(const WeaknessParameters& p, int generations) {
  const auto find = [&](const std::string& path, const char* key) {
    try {
      return TreePair::id_of(path, generations);
    } catch (const InputError& error) {
      throw InputError(error.what(), key);
    }
  };
  std::vector<Range> marks[2];
  for (const std::string& path : p.vessels) {
    const std::uint64_t id = find(path, "weakness.vessels"), place = TreePair::place_of(id);
    marks[side(TreePair::kind_of(id))].push_back({place, place + 1});
  }
  for (const std::string& path : p.subtrees) {
    const std::uint64_t id = find(path, "weakness.subtrees"), place = TreePair::place_of(id);
    for (int down = 0; down < generations - TreePair::generation_of(place); ++down)
      marks[side(TreePair::kind_of(id))].push_back({place << down, (place + 1) << down});
  }
  for (const VesselKind kind : {VesselKind::artery, VesselKind::vein})
    mark(kind, std::move(marks[side(kind)]));
}

bool WallVariation::marked(VesselKind kind, std::uint64_t number) const {
  return !marked_in(kind, number, number + 1).empty();
}

std::vector<WallVariation::Range> WallVariation::marked_in(VesselKind kind, std::uint64_t first,
                                                           std::uint64_t past) const {
  const std::vector<Range>& marks = marks_[side(kind)];
  std::vector<Range> within;
  auto at = std::partition_point(marks.begin(), marks.end(), [&](const Range& r) { return r.past <= first; });
  for (; at != marks.end() && at->first < past; ++at)
    within.push_back({std::max(first, at->first), std::min(past, at->past)});
  return within;
}

WallFactors WallVariation::of(VesselKind kind, std::uint64_t number) const {
  WallFactors factors{strength_(kind, number), thickness_(kind, number)};
  if (marked(kind, number)) {
    factors.strength *= weak_.strength;
    factors.thickness *= weak_.thickness;
  }
  return factors;
}

}  // namespace rhexis::network
