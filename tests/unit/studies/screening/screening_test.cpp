// SPDX-License-Identifier: BSD-3-Clause
// The screening of a tree against every vessel's risk from the flow in long double: list, counts and
// histograms. On any ranks, the same.
#include "studies/screening/screening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "network/wall.hpp"
#include "support/trees.hpp"

namespace rhexis::screening {
namespace {

using hemodynamics::TreeFlow;
using network::TreePair;
using network::VesselKind;
using network::WallVariation;

constexpr double inlet = 12600, outlet = 600;
const Criterion criterion{0.05, 3.5e6, 0.25, 300};

parallel::Communicator world() {
  return parallel::Communicator::world();
}

Screening screen(const network::TreeRules& rules, const WallVariation& variation, std::size_t top) {
  const TreePair tree(rules);
  const TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, world(), variation.varies());
  TreeScreening screening(tree, variation, criterion, top);
  flow.sweep([&](int thread) -> hemodynamics::VesselConsumer& { return screening.consumer(thread); });
  return screening.result(world());
}

/// [2 places - 2], by id.
std::vector<double> all_risks(const network::TreeRules& rules, const WallVariation& variation) {
  const test::LongDoubleTree exact(rules, test::in_vivo(), inlet, outlet);
  const auto risk_of = [&](VesselKind kind, std::uint64_t place) {
    const bool artery = kind == VesselKind::artery;
    const auto radius = static_cast<double>(exact.radius[place]) * (artery ? 1 : rules.vein_radius_ratio);
    const auto near = artery ? exact.artery_near[place] : exact.vein_near[place];
    const auto far = artery ? exact.artery_far[place] : exact.vein_far[place];
    const network::Wall& wall = artery ? rules.artery_wall : rules.vein_wall;
    return risk(criterion, static_cast<double>((near + far) / 2), wall.relative_thickness(radius),
                variation.of(kind, place));
  };
  std::vector<double> risks;
  for (std::uint64_t place = 1; place < exact.radius.size(); ++place) {
    risks.push_back(risk_of(VesselKind::artery, place));
    risks.push_back(risk_of(VesselKind::vein, place));
  }
  return risks;
}

network::TreeRules walled(network::TreeRules rules) {
  rules.artery_wall = {network::WallRule::radius, 0};
  rules.vein_wall = {network::WallRule::ratio, 0.1};
  return rules;
}

network::WeaknessParameters scatter() {
  network::WeaknessParameters p;
  p.strength_spread = 0.2;
  p.thickness_spread = 0.1;
  p.strength = 0.4;
  p.thickness = 0.7;
  p.seed = 11;
  return p;
}

TEST(Screening, AgreesWithEveryVesselsOwnRisk) {
  for (const int k : {1, 2, 5, 12, 14}) {
    for (const bool random : {false, true}) {
      const network::TreeRules rules = walled(random ? test::random_rules(k) : test::plain_rules(k));
      network::WeaknessParameters weakness = scatter();
      if (k > 2) weakness.subtrees = {"vein.01"};
      weakness.vessels = {"artery."};
      WallVariation variation(weakness);
      variation.mark_in_tree(weakness, k);
      const std::vector<double> risks = all_risks(rules, variation);
      const Screening s = screen(rules, variation, 30);
      EXPECT_EQ(s.vessels, static_cast<double>(risks.size()));

      std::vector<std::uint64_t> order(risks.size());
      for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
      std::sort(order.begin(), order.end(), [&](auto a, auto b) { return risks[a] > risks[b]; });
      ASSERT_EQ(s.top.size(), std::min<std::size_t>(30, risks.size()));
      for (std::size_t i = 0; i < s.top.size(); ++i) {
        EXPECT_EQ(s.top[i].vessel, order[i]) << "rank " << i << " at k = " << k;
        EXPECT_NEAR(s.top[i].risk / risks[order[i]], 1, 1e-12);
      }
      double above = 0;
      for (const double r : risks) above += r > 1 ? 1 : 0;
      EXPECT_EQ(s.above, above);
      for (std::size_t g = 1; g < s.generations.size(); ++g) {
        for (std::size_t kind = 0; kind < 2; ++kind) {
          std::vector<std::uint64_t> counts(s.bins.count);
          for (std::uint64_t place = std::uint64_t{1} << (g - 1); place < std::uint64_t{1} << g; ++place) {
            const double r = risks[2 * (place - 1) + kind];
            for (std::size_t b = 0; b < s.bins.count; ++b) {
              if (r >= s.bins.lower_edge(b) && r < s.bins.upper_edge(b)) ++counts[b];
            }
          }
          EXPECT_EQ(s.generations[g].counts[kind], counts);
        }
      }
    }
  }
}

// Wherever a weak vessel is, it comes first, and no other does.
TEST(Screening, RanksTheWeakVesselFirstWhereverItIs) {
  constexpr int k = 16;
  const network::TreeRules rules = walled(test::random_rules(k));
  for (int i = 0; i < 24; ++i) {
    // The hoop strain of the walls' rule varies twenty-fold over the tree, so a hundredth outdoes all.
    const std::uint64_t id =
        network::draw(5, network::Stream::splits, static_cast<std::uint64_t>(i)) % TreePair::vessels_of(k);
    network::WeaknessParameters weakness;
    weakness.strength = 0.01;
    weakness.vessels = {TreePair::path_of(id)};
    WallVariation variation(weakness);
    variation.mark_in_tree(weakness, k);
    const Screening s = screen(rules, variation, 3);
    ASSERT_EQ(s.top.size(), 3u);
    EXPECT_EQ(s.top[0].vessel, id);
    EXPECT_GT(s.top[0].risk, 2 * s.top[1].risk);
  }
}

// Where a generation is alike, one vessel stands for all of it but the weak ones: also of 2^40.
TEST(Screening, TellsWeakVesselsFromAGenerationThatIsAlike) {
  network::WeaknessParameters weakness;
  weakness.strength = 0.5;
  weakness.vessels = {"artery.0000000000", "artery.0000000001"};
  for (const int k : {12, 40}) {
    const network::TreeRules rules = walled(test::plain_rules(k));
    WallVariation variation(weakness);
    variation.mark_in_tree(weakness, k);
    const Screening s = screen(rules, variation, 100);
    EXPECT_EQ(s.vessels, static_cast<double>(TreePair::vessels_of(k)));
    double marked = 0, others = 0;
    for (const RankedVessel& v : s.top) {
      if (TreePair::generation_of(TreePair::place_of(v.vessel)) != 10 ||
          TreePair::kind_of(v.vessel) == VesselKind::vein)
        continue;
      (v.vessel == TreePair::id_of("artery.0000000000", k) ? marked : others) += v.alike;
    }
    EXPECT_EQ(marked, 2);
    EXPECT_EQ(others, 1022);
  }
}

TEST(Screening, LeavesOutWhatIsUnderNoTension) {
  const network::TreeRules rules = walled(test::random_rules(9));
  const TreePair tree(rules);
  const TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, world());
  const WallVariation variation;
  TreeScreening screening(tree, variation, {0.05, 3.5e6, 0.25, 2 * inlet}, 10);
  flow.sweep([&](int thread) -> hemodynamics::VesselConsumer& { return screening.consumer(thread); });
  const Screening s = screening.result(world());
  EXPECT_TRUE(s.top.empty());
  EXPECT_EQ(s.above, 0);
  EXPECT_EQ(s.vessels, static_cast<double>(tree.vessels()));
}

}  // namespace
}  // namespace rhexis::screening
