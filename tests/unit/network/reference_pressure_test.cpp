// SPDX-License-Identifier: BSD-3-Clause
#include "network/repair/reference_pressure.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/error.hpp"
#include "networks.hpp"

using namespace rhexis;
using namespace rhexis::network;
using networks::inflow;
using networks::pressure;

namespace {

/// Two parts: 0-1-2 with `flows` at its junctions, and 3-4 with a pressure.
BoundedGraph two_parts(const std::vector<double>& flows) {
  BoundedGraph network{networks::graph(5, {{0, 1}, {1, 2}, {3, 4}}), {pressure(3, 7), inflow(4, 1e-9)}};
  for (std::uint32_t j = 0; j < flows.size(); ++j) network.conditions.push_back(inflow(j, flows[j]));
  return network;
}

}  // namespace

TEST(ReferencePressure, StandsWhereMostFlowsOut) {
  BoundedGraph network = two_parts({3e-9, -1e-9, -2e-9});
  set_reference_pressure(1000.0, network);
  EXPECT_EQ(network.conditions[4].junction, 2u);
  EXPECT_EQ(network.conditions[4].kind, BoundaryCondition::Kind::pressure);
  EXPECT_EQ(network.conditions[4].value, 1000);
  EXPECT_EQ(network.conditions[3].kind, BoundaryCondition::Kind::flow);
  EXPECT_EQ(network.conditions[0].value, 7);  // the other part has its own
  ASSERT_EQ(network.notes.size(), 1u);
  EXPECT_NE(network.notes[0].find("junction 2 has network.reference_pressure, 7.501 mmHg"), std::string::npos)
      << network.notes[0];
  EXPECT_EQ(network.notes[0].find("becomes"), std::string::npos) << network.notes[0];
  // Flows that sum to zero as they are written leave a rounding; those that do not are told.
  network = two_parts({0.1e-9, 0.2e-9, -0.3e-9});
  set_reference_pressure(1000.0, network);
  EXPECT_EQ(network.notes[0].find("becomes"), std::string::npos) << network.notes[0];
  network = two_parts({3e-9, -1e-9, -1.999e-9});
  set_reference_pressure(1000.0, network);
  EXPECT_NE(network.notes[0].find("-119.9 uL/min, becomes -120 uL/min"), std::string::npos)
      << network.notes[0];
}

TEST(ReferencePressure, FlowsThatDoNotSumToZeroAreRefusedWithTheirSum) {
  for (const double out : {-1.9e-9, -2.1e-9}) {
    BoundedGraph network = two_parts({2e-9, out});
    try {
      set_reference_pressure(1000.0, network);
      FAIL() << out;
    } catch (const InputError& error) {
      EXPECT_EQ(error.key, "network.reference_pressure");
      const std::string sum = out < -2e-9 ? "sum to -6 uL/min" : "sum to 6 uL/min";
      EXPECT_NE(std::string(error.what()).find(sum), std::string::npos) << error.what();
    }
  }
  BoundedGraph network = two_parts({2e-9, -1.999e-9});  // within a thousandth
  EXPECT_NO_THROW(set_reference_pressure(1000.0, network));
  network = two_parts({2e-9});  // one flow, and nowhere to go
  EXPECT_THROW(set_reference_pressure(1000.0, network), InputError);
}

TEST(ReferencePressure, WithoutOneOrWithoutNeedNothingChanges) {
  BoundedGraph network = two_parts({1e-9, -1e-9});
  set_reference_pressure({}, network);
  EXPECT_EQ(network.conditions[3].kind, BoundaryCondition::Kind::flow);
  EXPECT_TRUE(network.notes.empty());
  network.conditions.resize(2);
  set_reference_pressure(5.0, network);
  ASSERT_EQ(network.notes.size(), 1u);
  EXPECT_NE(network.notes[0].find("no effect"), std::string::npos);
}
