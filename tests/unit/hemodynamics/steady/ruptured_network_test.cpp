// SPDX-License-Identifier: BSD-3-Clause
// Several leaks and occlusions at once, against closed forms and the orifice law.
#include "hemodynamics/steady/ruptured_network.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"

namespace rhexis::hemodynamics {
namespace {

using Kind = network::BoundaryCondition::Kind;

/// From junction 0 two ways to junction 3, by 1 and by 2.
network::Graph diamond() {
  network::Graph graph;
  graph.junctions = 4;
  graph.from = {0, 1, 0, 2};
  graph.to = {1, 3, 2, 3};
  return graph;
}
const std::vector<double> conductance{1e-9, 2e-9, 4e-9, 1e-9};
const std::vector<network::BoundaryCondition> conditions{{0, Kind::pressure, 16000, 0},
                                                         {3, Kind::pressure, 600, 0}};
const hemodynamics::GraphSolverOptions tight{.imbalance = 1e-12};

TEST(RupturedNetwork, OneLeakAsTheClosedForm) {
  for (const double strength : {1e-11, 1e-9, 1e-6}) {
    const Orifice orifice{strength, 300};
    RupturedNetwork ruptured(diamond(), conductance, conditions, {{0, false, orifice}});
    const auto result = ruptured.solve(tight);
    const double up = 0.5 / conductance[0], down = 0.5 / conductance[0] + 1 / conductance[1];
    const double open = (16000 * down + 600 * up) / (up + down);
    const double leak = orifice_leak(open - 300, up * down / (up + down), strength);
    EXPECT_NEAR(result.leaks[0] / leak, 1, 1e-8);
    EXPECT_EQ(result.flow.pressure.size(), 4u);
    EXPECT_EQ(result.flow.flow.size(), 4u);
    const double middle = open - leak * up * down / (up + down);
    EXPECT_NEAR(result.flow.flow[0], (16000 - middle) / up, 1e-8 * result.flow.inflow);
    EXPECT_NEAR(result.flow.flow[1] + result.leaks[0], result.flow.flow[0], 1e-8 * result.flow.inflow);
  }
}

TEST(RupturedNetwork, SeveralLeaksObeyTheirLawsTogether) {
  const double strength[] = {2e-9, 3e-8, 5e-7};
  RupturedNetwork ruptured(
      diamond(), conductance, conditions,
      {{0, false, {strength[0], 0}}, {2, false, {strength[1], 900}}, {3, false, {strength[2], 0}}});
  const auto result = ruptured.solve(tight);
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const network::BoundaryCondition& leak = ruptured.conditions()[2 + i];
    // Q^2 = S^2 (P - P_outside), with P - P_outside = R Q of the resistance that stands for the leak.
    EXPECT_NEAR(result.leaks[i] / (strength[i] * strength[i] * leak.resistance), 1, 1e-8);
    sum += result.leaks[i];
  }
  const double out = result.flow.flow[1] + (result.flow.flow[3] - result.leaks[2]);
  EXPECT_NEAR(result.flow.inflow, sum + out, 1e-9 * result.flow.inflow);
}

TEST(RupturedNetwork, TooFewRoundsAreAnError) {
  RupturedNetwork ruptured(diamond(), conductance, conditions, {{0, false, {1e-8, 0}}});
  EXPECT_THROW(ruptured.solve(tight, 1), RunError);
}

TEST(RupturedNetwork, NothingLeaksAgainstThePressureOutside) {
  RupturedNetwork ruptured(diamond(), conductance, conditions, {{1, false, {1e-8, 20000}}});
  const auto result = ruptured.solve(tight);
  EXPECT_LT(std::abs(result.leaks[0]), 1e-8 * result.flow.inflow);
}

TEST(RupturedNetwork, AnOccludedVesselCarriesNothingAndItsPressureRisesUpstream) {
  RupturedNetwork ruptured(diamond(), conductance, conditions, {{1, true, {}}});
  const auto result = ruptured.solve(tight);
  EXPECT_LT(std::abs(result.flow.flow[1]), 1e-8 * result.flow.inflow);
  EXPECT_NEAR(result.flow.pressure[1], 16000, 1e-4);
  EXPECT_NEAR(result.flow.flow[2], (16000 - 600) * 0.8e-9, 1e-8 * result.flow.inflow);
  EXPECT_EQ(result.leaks[0], 0);
}

}  // namespace
}  // namespace rhexis::hemodynamics
