// SPDX-License-Identifier: BSD-3-Clause
// Flow in the tree pair against plain recursion in long double: every pressure to 1e-13 of the pressure
// difference, every flow to 1e-13 of itself. On any ranks and threads, to the last bit.
#include "hemodynamics/steady/tree/tree_flow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "hemodynamics/steady/tree/tree_statistics.hpp"
#include "network/wall.hpp"
#include "support/trees.hpp"

namespace rhexis::hemodynamics {
namespace {

using network::TreePair;
using network::TreeRules;

constexpr double inlet = 12600, outlet = 600;

parallel::Communicator world() {
  return parallel::Communicator::world();
}

struct Case {
  const char* name;
  TreeRules rules;
  Viscosity viscosity;
};

std::vector<Case> cases(int generations) {
  std::vector<Case> all;
  const Viscosity constant{};
  all.push_back({"symmetric", test::plain_rules(generations), constant});
  all.push_back({"symmetric, in vivo", test::plain_rules(generations), test::in_vivo()});
  all.push_back({"random", test::random_rules(generations), test::in_vivo()});
  all.push_back({"random, constant viscosity", test::random_rules(generations), constant});
  Case fixed{"asymmetric", test::plain_rules(generations), test::in_vivo()};
  fixed.rules.asymmetry = fixed.rules.least_asymmetry = 0.41;
  all.push_back(fixed);
  Case by_radius{"lengths by radius", test::random_rules(generations), test::in_vivo()};
  by_radius.rules.length_by_radius = {{1e-5, 5e-4}, {1e-4, 2e-3}, {1e-3, 4e-2}};
  all.push_back(by_radius);
  Case by_generation{"lengths by generation", test::random_rules(generations), test::in_vivo()};
  for (int g = 0; g < generations; ++g) by_generation.rules.length_ratio_by_generation.push_back(20 + 3 * g);
  all.push_back(by_generation);
  Case narrow{"narrow vessels", test::random_rules(generations), test::in_vivo()};
  narrow.rules.root_radius = 20e-6;
  all.push_back(narrow);
  return all;
}

TEST(TreeFlow, AgreesWithLongDoubleInEveryVessel) {
  for (const int k : {1, 2, 4, 9, 12, 14}) {
    for (const Case& c : cases(k)) {
      const TreePair tree(c.rules);
      const TreeFlow flow(tree, c.viscosity, {inlet, outlet, {}}, world());
      const test::LongDoubleTree exact(c.rules, c.viscosity, inlet, outlet);
      EXPECT_NEAR(flow.resistance() / static_cast<double>(exact.below[1]), 1, 1e-13) << c.name;
      std::vector<std::uint64_t> places;
      for (std::uint64_t place = 1; place <= tree.places(); ++place) places.push_back(place);
      const auto found = flow.at(places);
      double flow_error = 0, pressure_error = 0;
      for (const std::uint64_t p : places) {
        const PlaceFlow& f = found[p - 1];
        const auto worse = [](double& worst, long double value, long double truth, long double scale) {
          worst = std::max(worst, static_cast<double>(std::abs(value - truth) / scale));
        };
        worse(flow_error, f.flow, exact.flow[p], exact.flow[p]);
        worse(pressure_error, f.artery_near, exact.artery_near[p], inlet - outlet);
        worse(pressure_error, f.artery_far, exact.artery_far[p], inlet - outlet);
        worse(pressure_error, f.vein_near, exact.vein_near[p], inlet - outlet);
        worse(pressure_error, f.vein_far, exact.vein_far[p], inlet - outlet);
      }
      EXPECT_LT(flow_error, 1e-13) << c.name << ", k = " << k;
      EXPECT_LT(pressure_error, 1e-13) << c.name << ", k = " << k;
    }
  }
}

TEST(TreeFlow, DoesNotDependOnTheNumberOfRanks) {
  for (const int k : {5, 14, 17}) {
    const TreePair tree(test::random_rules(k));
    const TreeFlow all(tree, test::in_vivo(), {inlet, outlet, {}}, world());
    const TreeFlow alone(tree, test::in_vivo(), {inlet, outlet, {}}, parallel::Communicator(MPI_COMM_SELF));
    EXPECT_EQ(all.flow(), alone.flow());
    for (std::uint64_t id = 0; id < tree.vessels(); id += 1 + tree.vessels() / 97) {
      const VesselFlow a = all.query(id), b = alone.query(id);
      EXPECT_EQ(a.flow, b.flow);
      EXPECT_EQ(a.pressure_from, b.pressure_from);
      EXPECT_EQ(a.pressure_to, b.pressure_to);
    }
    const TreeStatistics s = gather_statistics(all, test::in_vivo(), world());
    const TreeStatistics t = gather_statistics(alone, test::in_vivo(), parallel::Communicator(MPI_COMM_SELF));
    EXPECT_EQ(s.volume, t.volume);
    for (std::size_t g = 0; g < s.generations.size(); ++g) {
      EXPECT_EQ(s.generations[g].flow.mean, t.generations[g].flow.mean);
      EXPECT_EQ(s.generations[g].pressure[1].mean, t.generations[g].pressure[1].mean);
      EXPECT_EQ(s.generations[g].stress_counts[0], t.generations[g].stress_counts[0]);
    }
  }
}

TEST(TreeFlow, TakesAnyTwoConditions) {
  const TreePair tree(test::random_rules(6));
  const TreeFlow pressures(tree, test::in_vivo(), {inlet, outlet, {}}, world());
  const TreeFlow from_inlet(tree, test::in_vivo(), {inlet, {}, pressures.flow()}, world());
  const TreeFlow from_outlet(tree, test::in_vivo(), {{}, outlet, pressures.flow()}, world());
  EXPECT_NEAR(from_inlet.outlet_pressure(), outlet, 1e-9);
  EXPECT_NEAR(from_outlet.inlet_pressure(), inlet, 1e-9);
  for (const TreeBoundary& wrong : {TreeBoundary{}, TreeBoundary{inlet, {}, {}}, TreeBoundary{{}, {}, 1e-5},
                                    TreeBoundary{inlet, outlet, 1e-5}}) {
    EXPECT_THROW(TreeFlow(tree, test::in_vivo(), wrong, world()), InputError);
  }
}

TEST(TreeFlow, QueriesFollowTheBlood) {
  const TreePair tree(test::random_rules(13));
  const TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, world());
  for (std::uint64_t id : {0ULL, 1ULL, 4ULL, 5ULL, 16000ULL, 16001ULL}) {
    const VesselFlow v = flow.query(id);
    EXPECT_GT(v.pressure_from, v.pressure_to) << id;
    EXPECT_GT(v.flow, 0);
  }
  EXPECT_THROW(flow.query(tree.vessels()), InputError);
}

TEST(TreeFlow, PathsLeadToTheWholeResistance) {
  for (const Case& c : cases(15)) {
    const TreePair tree(c.rules);
    const TreeFlow flow(tree, c.viscosity, {inlet, outlet, {}}, world());
    for (const std::uint64_t place : {1ULL, 5ULL, 1000ULL, 20000ULL, 32767ULL}) {
      const TreeFlow::Path path = flow.path_to(place);
      double below = path.below;
      for (std::size_t g = path.artery.size(); g-- > 0;) {
        if (g < path.beside.size()) below = 1 / (1 / below + 1 / path.beside[g]);
        below += path.artery[g] + path.vein[g];
      }
      EXPECT_NEAR(below / flow.resistance(), 1, 1e-13) << c.name << " " << place;
    }
  }
}

/// Everything that statistics tell, vessel by vessel in long double.
TEST(TreeStatistics, AgreeWithSumsOverAllVessels) {
  for (Case c : cases(13)) {
    c.rules.artery_wall.rule = network::WallRule::radius;
    c.rules.vein_wall.ratio = 0.1;
    const TreePair tree(c.rules);
    const TreeFlow flow(tree, c.viscosity, {inlet, outlet, {}}, world());
    const TreeStatistics s = gather_statistics(flow, c.viscosity, world());
    const test::LongDoubleTree exact(c.rules, c.viscosity, inlet, outlet);
    long double volume = 0, surface = 0, narrow = 0;
    for (const GenerationStatistics& g : s.generations) {
      long double flows = 0, pressures = 0, stresses = 0, vein_stresses = 0, lengths = 0, least = 1e9,
                  most = 0;
      const std::size_t first = std::size_t{1} << g.generation;
      for (std::size_t n = first; n < 2 * first; ++n) {
        const long double r = exact.radius[n], l = exact.length[n], ratio = c.rules.vein_radius_ratio;
        volume += std::numbers::pi_v<long double> * r * r * l * (1 + ratio * ratio);
        surface += 2 * std::numbers::pi_v<long double> * r * l * (1 + ratio);
        if (c.viscosity.law != ViscosityLaw::constant) {
          narrow += (2 * r < c.viscosity.least_diameter) + (2 * r * ratio < c.viscosity.least_diameter);
        }
        const long double p = (exact.artery_near[n] + exact.artery_far[n]) / 2;
        const long double vein = (exact.vein_near[n] + exact.vein_far[n]) / 2;
        flows += exact.flow[n];
        pressures += p;
        lengths += l;
        stresses += p * network::lumen_stress_factor(c.rules.artery_wall.relative_thickness(r));
        vein_stresses += vein * network::lumen_stress_factor(0.1L);
        least = std::min(least, p);
        most = std::max(most, p);
      }
      const auto near = [&](double value, long double total, const char* what) {
        EXPECT_NEAR(value / static_cast<double>(total / first), 1, 1e-13) << c.name << " " << what;
      };
      near(g.flow.mean, flows, "flow");
      near(g.pressure[0].mean, pressures, "pressure");
      near(g.hoop_stress[0].mean, stresses, "stress");
      near(g.hoop_stress[1].mean, vein_stresses, "stress in veins");
      near(g.mean_length, lengths, "length");
      EXPECT_NEAR(g.pressure[0].least / static_cast<double>(least), 1, 1e-12);
      EXPECT_NEAR(g.pressure[0].most / static_cast<double>(most), 1, 1e-12);
    }
    EXPECT_NEAR(s.volume / static_cast<double>(volume), 1, 1e-13) << c.name;
    EXPECT_NEAR(s.surface / static_cast<double>(surface), 1, 1e-13) << c.name;
    EXPECT_NEAR(s.narrow_vessels, static_cast<double>(narrow), 0.5) << c.name;
  }
}

TEST(TreeStatistics, HistogramsCountEveryVesselWhereItBelongs) {
  const TreePair tree(test::random_rules(12));
  const TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, world());
  const TreeStatistics s = gather_statistics(flow, test::in_vivo(), world());
  const test::LongDoubleTree exact(tree.rules(), test::in_vivo(), inlet, outlet);
  const GenerationStatistics& last = s.generations.back();
  std::vector<std::uint64_t> flows(s.flow_bins.count), pressures(s.pressure_bins.count);
  const auto bin_of = [](const Bins& bins, double value) {
    std::size_t bin = 0;
    while (bin + 1 < bins.count && !(value >= bins.lower_edge(bin) && value < bins.upper_edge(bin))) ++bin;
    return bin;
  };
  for (std::size_t n = 2048; n < 4096; ++n) {
    ++flows[bin_of(s.flow_bins, static_cast<double>(exact.flow[n]))];
    ++pressures[bin_of(s.pressure_bins,
                       static_cast<double>((exact.artery_near[n] + exact.artery_far[n]) / 2))];
  }
  EXPECT_EQ(last.flow_counts, flows);
  EXPECT_EQ(last.pressure_counts[0], pressures);
}

TEST(TreeStatistics, BloodThatRunsBackwardsIsCountedByItsMagnitude) {
  const network::TreePair tree(test::random_rules(9));
  const TreeFlow forth(tree, test::in_vivo(), {inlet, outlet, {}}, world());
  const TreeFlow back(tree, test::in_vivo(), {outlet, inlet, {}}, world());
  const TreeStatistics s = gather_statistics(forth, test::in_vivo(), world());
  const TreeStatistics t = gather_statistics(back, test::in_vivo(), world());
  for (std::size_t g = 0; g < s.generations.size(); ++g) {
    EXPECT_EQ(t.generations[g].flow.mean, -s.generations[g].flow.mean);
    EXPECT_EQ(t.generations[g].flow_counts, s.generations[g].flow_counts);
  }
}

/// Where each generation has more wall, or longer vessels, than the one before.
TEST(TreeStatistics, SumsFitHoweverTheyGrow) {
  TreeRules rules = test::plain_rules(34);
  rules.exponent = 6;
  const TreePair spreading(rules);
  const TreeStatistics s =
      gather_statistics(TreeFlow(spreading, {}, {inlet, outlet, {}}, world()), {}, world());
  double surface = 0;
  for (int g = 0; g < 34; ++g)
    surface += 2 * 2 * std::numbers::pi * 40 * std::pow(12.5e-3, 2) * std::exp2(g * (1 - 2 / 6.0));
  EXPECT_NEAR(s.surface / surface, 1, 1e-12);

  rules = test::random_rules(18);
  rules.length_ratio_by_generation.assign(18, 50);
  rules.length_ratio_by_generation[0] = 1e-3;
  const TreePair stub(rules);
  rules.length_ratio_by_generation[0] = 50;
  const TreePair even(rules);
  const auto lengths = [](const TreePair& tree) {
    return gather_statistics(TreeFlow(tree, {}, {inlet, outlet, {}}, world()), {}, world())
        .generations.back()
        .mean_length;
  };
  EXPECT_EQ(lengths(stub), lengths(even));
}

TEST(TreeStatistics, BloodAtRestHasNumbers) {
  const network::TreePair tree(test::random_rules(9));
  for (const double pressure : {inlet, 0.0}) {
    const TreeFlow rest(tree, test::in_vivo(), {pressure, pressure, {}}, world());
    for (const GenerationStatistics& g : gather_statistics(rest, test::in_vivo(), world()).generations) {
      EXPECT_EQ(g.flow.mean, 0);
      EXPECT_NEAR(g.pressure[0].mean, pressure, 1e-9 * pressure);
      EXPECT_TRUE(std::isfinite(g.hoop_stress[1].mean));
    }
  }
}

TEST(TreeFlow, WholeBodyWithoutVariationIsImmediate) {
  const TreePair tree(test::plain_rules(40));
  const TreeFlow flow(tree, test::in_vivo(), {inlet, outlet, {}}, world());
  const TreeStatistics s = gather_statistics(flow, test::in_vivo(), world());
  EXPECT_NEAR(s.generations.back().flow.mean * std::ldexp(1.0, 39) / flow.flow(), 1, 1e-13);
  const VesselFlow last = flow.query(tree.vessels() - 1);
  EXPECT_NEAR(last.pressure_from, 0.5 * (inlet + outlet),
              1e-8);  // alike on both sides: half way at the midplane
}

}  // namespace
}  // namespace rhexis::hemodynamics
