// SPDX-License-Identifier: BSD-3-Clause
// A leak through an orifice, against closed forms of small networks and against the same tree as a graph.
#include "hemodynamics/steady/bleeding.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hemodynamics/poiseuille.hpp"
#include "support/trees.hpp"

namespace rhexis::hemodynamics {
namespace {

using Kind = network::BoundaryCondition::Kind;

/// Two vessels in a row, resistances r1 and r2, pressures p0 and p2 at their ends.
std::unique_ptr<VesselInNetwork> two_vessels(double r1, double r2, double p0, double p2) {
  network::Graph graph;
  graph.junctions = 3;
  graph.from = {0, 1};
  graph.to = {1, 2};
  return vessel_in_graph(graph, {1 / r1, 1 / r2}, {{0, Kind::pressure, p0, 0}, {2, Kind::pressure, p2, 0}},
                         1);
}

TEST(Bleeding, TwoVesselsWithAnOrifice) {
  const double r1 = 1e9, r2 = 4e9, p0 = 24000, p2 = 600;
  const auto network = two_vessels(r1, r2, p0, p2);
  for (const double strength : {1e-12, 1e-9, 8e-8, 1e-5}) {
    for (const double outside : {-500.0, 0.0, 2000.0}) {
      const VesselState s = bleed(*network, 1, {strength, outside});
      // From the middle of the second vessel: r1 + r2/2 on one side, r2/2 on the other.
      const double up = r1 + r2 / 2, down = r2 / 2;
      const double open = (p0 * down + p2 * up) / (up + down), behind = up * down / (up + down);
      const double b = behind * strength;
      const double y = (-b + std::sqrt(b * b + 4 * (open - outside))) / 2;
      EXPECT_NEAR(s.leak / (strength * y), 1, 1e-7) << strength << " " << outside;
      EXPECT_NEAR(s.pressure_middle, outside + y * y, 1e-6 * open);
      EXPECT_NEAR(s.leak, strength * std::sqrt(s.pressure_middle - outside), 1e-7 * s.leak);
      EXPECT_NEAR(s.flow_from, (p0 - s.pressure_middle) / up, 1e-10 * s.inflow);
      EXPECT_NEAR(s.flow_to, (s.pressure_middle - p2) / down, 1e-10 * s.inflow);
      EXPECT_LT(s.imbalance(), 1e-10);
    }
  }
}

TEST(Bleeding, NothingLeavesAgainstThePressureOutside) {
  const auto network = two_vessels(1e9, 1e9, 1000, 500);
  const VesselState s = bleed(*network, 1, {1e-7, 900});
  EXPECT_EQ(s.leak, 0);
  EXPECT_NEAR(s.pressure_middle, 625, 1e-9);
}

TEST(Bleeding, TheLumenChangesItsResistance) {
  const auto network = two_vessels(1e9, 4e9, 5000, 0);
  const VesselState s = network->solve(0.5, 0, 0);
  EXPECT_NEAR(s.inflow, 5000 / 3e9, 1e-18);
  EXPECT_NEAR(s.pressure_from, 5000 - 1e9 * s.inflow, 1e-9);
}

TEST(OrificeLeak, Limits) {
  EXPECT_EQ(orifice_leak(0, 1e9, 1e-7), 0);
  EXPECT_EQ(orifice_leak(-5, 1e9, 1e-7), 0);
  EXPECT_EQ(orifice_leak(100, 1e9, 0), 0);
  EXPECT_DOUBLE_EQ(orifice_leak(100, 0, 1e-7), 1e-6);  // no resistance: the law itself
  EXPECT_NEAR(orifice_leak(100, 1e9, 1e3), 100 / 1e9,
              1e-18);  // wide open: all that the resistance lets through
}

TEST(VesselInNetwork, TreeAndGraphAgree) {
  const network::TreePair tree(test::random_rules(9));
  const hemodynamics::TreeFlow flow(tree, test::in_vivo(), {12600, 600, {}}, parallel::Communicator::world());
  const network::Graph graph = tree.materialise(false);
  std::vector<double> conductance;
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    const double eta = hemodynamics::apparent_viscosity(test::in_vivo(), graph.radius[v], 0.45);
    conductance.push_back(1 / hemodynamics::poiseuille_resistance(graph.radius[v], graph.length[v], eta));
  }
  const auto end = static_cast<std::uint32_t>(std::size_t{1} << tree.generations());
  for (const std::uint32_t vessel : {0u, 1u, 6u, 77u, static_cast<std::uint32_t>(tree.vessels() - 1)}) {
    const auto in_tree = vessel_in_tree(flow, vessel);
    const auto in_graph = vessel_in_graph(
        graph, conductance, {{0, Kind::pressure, 12600, 0}, {end, Kind::pressure, 600, 0}}, vessel);
    for (const double strength : {0.0, 1e-10, 1e-8}) {
      const VesselState a = bleed(*in_tree, 0.8, {strength, -200}),
                        b = bleed(*in_graph, 0.8, {strength, -200});
      EXPECT_NEAR(a.leak, b.leak, 1e-9 * a.inflow) << vessel;
      EXPECT_NEAR(a.inflow, b.inflow, 1e-9 * a.inflow) << vessel;
      EXPECT_NEAR(a.outflow, b.outflow, 1e-9 * a.inflow) << vessel;
      EXPECT_NEAR(a.pressure_from, b.pressure_from, 1e-5) << vessel;
      EXPECT_NEAR(a.pressure_middle, b.pressure_middle, 1e-5) << vessel;
      EXPECT_NEAR(a.pressure_to, b.pressure_to, 1e-5) << vessel;
      EXPECT_LT(a.imbalance(), 1e-10);
      EXPECT_LT(b.imbalance(), 1e-10);
    }
  }
}

}  // namespace
}  // namespace rhexis::hemodynamics
