// SPDX-License-Identifier: BSD-3-Clause
// The implicit tree pair: numbering, the rule of radii, positions. Tolerances are a few roundings.
#include "network/tree/tree_pair.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/error.hpp"
#include "support/trees.hpp"

namespace rhexis::network {
namespace {

double distance(const Point& a, const Point& b) {
  return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                   (a[2] - b[2]) * (a[2] - b[2]));
}

TEST(TreePair, CountsVesselsAsThePaperDoes) {
  EXPECT_EQ(TreePair(test::plain_rules(4)).vessels(), 30u);
  EXPECT_EQ(TreePair(test::plain_rules(24)).vessels(), 33554430u);
  EXPECT_EQ(TreePair(test::plain_rules(34)).vessels(), 34359738366u);
  EXPECT_EQ(TreePair(test::plain_rules(40)).vessels(), 2199023255550u);
}

TEST(TreePair, PathsAndIdsTurnIntoEachOther) {
  const TreePair tree(test::random_rules(40));
  EXPECT_EQ(tree.id_of("artery."), 0u);
  EXPECT_EQ(tree.id_of("vein."), 1u);
  EXPECT_EQ(tree.id_of("artery.0"), 2u);
  EXPECT_EQ(tree.id_of("vein.11"), 13u);
  EXPECT_EQ(tree.id_of("17"), 17u);
  for (const std::uint64_t id : {0ULL, 1ULL, 12345ULL, 2199023255549ULL}) {
    EXPECT_EQ(tree.id_of(TreePair::path_of(id)), id);
  }
  for (const char* wrong : {"", "aorta", "artery.2", "vein", "-1", "2199023255550", "artery.0 "}) {
    EXPECT_THROW(tree.id_of(wrong), InputError) << wrong;
  }
  EXPECT_THROW(TreePair(test::plain_rules(3)).id_of("artery.000"), InputError);
}

TEST(TreePair, RadiiFollowTheRuleAtEveryBifurcation) {
  for (const TreeRules& rules : {test::plain_rules(10), test::random_rules(10)}) {
    const TreePair tree(rules);
    for (std::uint64_t place = 1; place < 512; ++place) {
      const auto power = [&](std::uint64_t p) {
        return std::pow(tree.vessel(TreePair::id_of(p, VesselKind::artery)).radius, rules.exponent);
      };
      EXPECT_NEAR((power(2 * place) + power(2 * place + 1)) / power(place), 1, 1e-13);
    }
  }
}

TEST(TreePair, RandomDaughtersStayWithinTheAsymmetriesAndFavourNoSide) {
  const TreePair tree(test::random_rules(14));
  double mean = 0;
  std::set<double> shares;
  for (std::uint64_t place = 1; place < 8192; ++place) {
    const double first = tree.first_share(place), small = std::min(first, 1 - first);
    const double gamma = std::pow(small / (1 - small), 2 / tree.rules().exponent);
    EXPECT_GE(gamma, 0.3 - 1e-9);
    EXPECT_LE(gamma, 0.95 + 1e-9);
    mean += first / 8191;
    shares.insert(first);
  }
  EXPECT_NEAR(mean, 0.5, 0.01);  // standard error 0.0015
  EXPECT_GT(shares.size(), 8180u);
}

TEST(TreePair, AnotherSeedMakesAnotherTree) {
  TreeRules rules = test::random_rules(5);
  const double one = TreePair(rules).first_share(3);
  ++rules.seed;
  EXPECT_NE(TreePair(rules).first_share(3), one);
}

TEST(TreePair, ExponentFromTerminalRadius) {
  EXPECT_NEAR(exponent_between(12.5e-3, 3.14e-6, 34), 2.76, 0.003);
  TreeRules rules = test::plain_rules(34);
  rules.exponent = exponent_between(12.5e-3, 3e-6, 34);
  const TreePair tree(rules);
  EXPECT_NEAR(tree.vessel(tree.vessels() - 2).radius / 3e-6, 1, 1e-12);
}

TEST(TreePair, VesselsJoinEndToEndAndMeetAtTheMidplane) {
  for (const TreeLayout layout : {TreeLayout::planar, TreeLayout::spatial}) {
    TreeRules rules = test::random_rules(9);
    rules.layout = layout;
    const TreePair tree(rules);
    const Graph graph = tree.materialise();
    ASSERT_EQ(graph.vessels(), tree.vessels());
    ASSERT_EQ(graph.junctions, tree.junctions());
    for (std::uint64_t id = 0; id < tree.vessels(); ++id) {
      const TreeVessel v = tree.vessel(id);
      EXPECT_EQ(graph.from[id], v.from);
      EXPECT_EQ(graph.to[id], v.to);
      EXPECT_EQ(graph.radius[id], v.radius);
      EXPECT_EQ(graph.length[id], v.length);
      EXPECT_EQ(graph.kind[id], v.kind);
      EXPECT_EQ(graph.generation[id], v.generation);
      const auto at = [&](std::uint64_t j) { return Point{graph.x[j], graph.y[j], graph.z[j]}; };
      EXPECT_EQ(at(v.from), v.start);
      EXPECT_EQ(at(v.to), v.end);
      // Every vessel leads towards (artery) or away from (vein) the midplane, and neither tree crosses it.
      EXPECT_LT(v.start[0], v.end[0]);
      if (v.kind == VesselKind::artery) {
        EXPECT_LE(v.end[0], 0);
      } else {
        EXPECT_GE(v.start[0], 0);
      }
      if (v.generation == 8) {
        EXPECT_EQ((v.kind == VesselKind::artery ? v.end : v.start)[0], 0);
      }
      if (layout == TreeLayout::planar) {
        EXPECT_EQ(v.end[2], 0);
      }
    }
  }
}

TEST(TreePair, SymmetricVesselsAreAsLongAsDrawnAndOpenAtMurraysAngle) {
  TreeRules rules = test::plain_rules(6);
  rules.exponent = 3;
  const TreePair tree(rules);
  for (std::uint64_t id = 0; id < tree.vessels(); ++id) {
    const TreeVessel v = tree.vessel(id);
    EXPECT_NEAR(distance(v.start, v.end) / v.length, 1, 1e-12);
  }
  const TreeVessel one = tree.vessel(2), two = tree.vessel(4);
  double dot = 0;
  for (std::size_t i = 0; i < 3; ++i) dot += (one.end[i] - one.start[i]) * (two.end[i] - two.start[i]);
  const double angle = std::acos(dot / (one.length * two.length)) * 180 / std::numbers::pi;
  EXPECT_NEAR(angle, 74.93, 0.02);  // twice arccos(2^(-1/3))
}

TEST(TreePair, AsymmetryDoesNotMakeTheTreeDriftSideways) {
  TreeRules rules = test::plain_rules(12);
  rules.asymmetry = 0.4;
  const TreePair tree(rules);
  const Graph graph = tree.materialise();
  double mean[2] = {}, square[2] = {};
  for (std::uint64_t place = 2048; place < 4096; ++place) {
    mean[0] += graph.y[place] / 2048;
    mean[1] += graph.z[place] / 2048;
    square[0] += graph.y[place] * graph.y[place] / 2048;
    square[1] += graph.z[place] * graph.z[place] / 2048;
  }
  // The first bifurcation has no counterpart to balance it; it alone may shift the mean.
  for (int i = 0; i < 2; ++i) EXPECT_LT(std::abs(mean[i]), 0.5 * std::sqrt(square[i]));
}

TEST(TreePair, LengthsByGenerationAndByRadius) {
  TreeRules rules = test::plain_rules(3);
  rules.length_ratio_by_generation = {10, 20, 30};
  const TreeVessel leaf = TreePair(rules).vessel(12);
  EXPECT_NEAR(leaf.length / leaf.radius, 30, 1e-12);
  rules.length_ratio_by_generation.clear();
  rules.length_by_radius = {{1e-3, 10e-3}, {4e-3, 40e-3}, {16e-3, 80e-3}};
  EXPECT_NEAR(rules.length(0, 2e-3), 20e-3, 1e-15);
  EXPECT_NEAR(rules.length(0, 8e-3), 40e-3 * std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(rules.length(0, 0.5e-3), 5e-3, 1e-15);  // the outer lines go on
}

TEST(TreePair, RefusesAbsentVesselsAndTooLargeGraphs) {
  EXPECT_THROW(TreePair(test::plain_rules(4)).vessel(30), InputError);
  EXPECT_THROW(TreePair(test::plain_rules(31)).materialise(), RunError);
}

}  // namespace
}  // namespace rhexis::network
