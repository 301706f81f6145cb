// SPDX-License-Identifier: BSD-3-Clause
#include "network/connectivity.hpp"

#include <gtest/gtest.h>

#include <string>

#include "networks.hpp"

using namespace rhexis;
using namespace rhexis::network;
using networks::inflow;
using networks::pressure;

namespace {

/// One letter a vessel: 'f' where it can carry flow, '.' where it cannot.
std::string carrying(const Graph& graph, const std::vector<BoundaryCondition>& conditions) {
  std::string text;
  for (const bool carries : can_carry_flow(graph, conditions)) text += carries ? 'f' : '.';
  return text;
}

}  // namespace

TEST(Connectivity, PartsAreNamedByTheirFirstJunction) {
  const Graph g = networks::graph(7, {{5, 2}, {0, 6}, {2, 3}, {6, 0}});
  EXPECT_EQ(first_of_part(g), (std::vector<std::uint32_t>{0, 1, 2, 2, 4, 2, 0}));
  EXPECT_EQ(degrees(g), (std::vector<std::uint32_t>{2, 0, 2, 1, 0, 1, 2}));
}

TEST(Connectivity, VesselsThatCanCarryFlow) {
  struct Case {
    const char* what;
    Graph graph;
    std::vector<BoundaryCondition> conditions;
    const char* expected;
  };
  const std::vector<Case> cases{
      {"a bifurcation",
       networks::graph(4, {{0, 1}, {1, 2}, {1, 3}}),
       {pressure(0, 1), pressure(2, 0)},
       "ff."},
      {"all its ends known",
       networks::graph(4, {{0, 1}, {1, 2}, {1, 3}}),
       {pressure(0, 1), pressure(2, 0), pressure(3, 0)},
       "fff"},
      {"an end that a flow of zero closes",
       networks::graph(4, {{0, 1}, {1, 2}, {1, 3}}),
       {pressure(0, 1), pressure(2, 0), inflow(3, 0)},
       "ff."},
      {"one condition", networks::graph(3, {{0, 1}, {1, 2}}), {pressure(0, 1)}, ".."},
      {"no condition", networks::graph(3, {{0, 1}, {1, 2}}), {}, ".."},
      {"a condition between two",
       networks::graph(3, {{0, 1}, {1, 2}}),
       {pressure(1, 1), pressure(2, 0)},
       ".f"},
      {"behind a resistance too",
       networks::graph(3, {{0, 1}, {1, 2}}),
       {pressure(0, 1, 5), pressure(2, 0, 7)},
       "ff"},
      {"parallel vessels on the way, and at the end of a dead end",
       networks::graph(5, {{0, 1}, {1, 0}, {1, 2}, {1, 3}, {3, 4}, {4, 3}}),
       {pressure(0, 1), pressure(2, 0)},
       "fff..."},
      {"a loop that hangs at one junction of the way",
       networks::graph(5, {{0, 1}, {1, 2}, {1, 3}, {3, 4}, {4, 1}}),
       {pressure(0, 1), pressure(2, 0)},
       "ff..."},
      {"a loop of the way",
       networks::graph(5, {{0, 1}, {1, 3}, {3, 4}, {4, 1}, {4, 2}}),
       {pressure(0, 1), pressure(2, 0)},
       "fffff"},
      {"two loops at one condition: the one between both carries flow",
       networks::graph(5, {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 2}}),
       {pressure(0, 1), pressure(2, 0)},
       "fff..."},
      {"two parts, one without conditions",
       networks::graph(4, {{2, 3}, {0, 1}}),
       {pressure(0, 1), inflow(1, -1)},
       ".f"},
  };
  for (const Case& c : cases) EXPECT_EQ(carrying(c.graph, c.conditions), c.expected) << c.what;
}

TEST(Connectivity, ALongChainNeedsNoDeepStack) {
  constexpr std::uint32_t vessels = 300000;
  Graph g;
  g.junctions = vessels + 1;
  for (std::uint32_t v = 0; v < vessels; ++v) {
    g.from.push_back(v);
    g.to.push_back(v + 1);
  }
  const std::vector<bool> carries = can_carry_flow(g, std::vector{pressure(0, 1), pressure(vessels - 1, 0)});
  EXPECT_TRUE(carries[0]);
  EXPECT_TRUE(carries[vessels - 2]);
  EXPECT_FALSE(carries[vessels - 1]);
}
