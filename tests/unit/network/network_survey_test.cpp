// SPDX-License-Identifier: BSD-3-Clause
#include "network/survey/network_survey.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "network/connectivity.hpp"
#include "network/survey/survey_text.hpp"
#include "networks.hpp"

using namespace rhexis;
using namespace rhexis::network;
using networks::inflow;
using networks::pressure;

using Names = std::vector<std::string>;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A trunk and two branches, 2 and 1.5 mm wide; `conditions` at in (0), o1 (2), o2 (3).
BoundedGraph bifurcation(std::vector<BoundaryCondition> conditions) {
  BoundedGraph network{networks::graph(4, {{0, 1}, {1, 2}, {1, 3}}), std::move(conditions)};
  Graph& g = network.graph;
  g.junction_name = {"in", "m", "o1", "o2"};
  g.vessel_name = {"t", "b1", "b2"};
  g.radius = {2e-3, 1.5e-3, 1.5e-3};
  g.length = {10e-3, 12e-3, 11e-3};
  g.x = {0, 10e-3, 20e-3, 20e-3};
  g.y = {0, 0, 5e-3, -5e-3};
  g.z = {0, 0, 0, 0};
  return network;
}

NetworkSurvey survey(const BoundedGraph& network) {
  return survey_of(network, first_of_part(network.graph));
}

std::string all_lines(const NetworkSurvey& survey) {
  std::string all;
  for (const auto& [label, text] : survey_lines(survey)) all += label + ": " + text + "\n";
  return all;
}

}  // namespace

TEST(NetworkSurvey, AForgottenOutletIsNamed) {
  const NetworkSurvey s = survey(bifurcation({pressure(0, 100), pressure(2, 90)}));
  EXPECT_EQ(s.vessels, 3u);
  EXPECT_EQ(s.parts, 1u);
  EXPECT_EQ(s.loops, 0u);
  EXPECT_EQ(s.ends, 3u);
  EXPECT_EQ(s.open_ends.names, (Names{"o2"}));
  EXPECT_EQ(s.dead_ends.names, (Names{"b2"}));
  EXPECT_EQ(s.without_flow(), 1u);
  ASSERT_EQ(survey_warnings(s).size(), 1u);
  EXPECT_TRUE(has(survey_warnings(s).front(), "nothing flows there: o2"));
  EXPECT_TRUE(has(all_lines(s), "no flow: in 1 of 3 vessels; 1 in dead ends")) << all_lines(s);
}

TEST(NetworkSurvey, NothingIsWrongWhereEveryEndHasACondition) {
  const NetworkSurvey s = survey(bifurcation({pressure(0, 100), pressure(2, 90), inflow(3, 0)}));
  EXPECT_EQ(s.open_ends.count, 0u);
  EXPECT_EQ(s.dead_ends.names, (Names{"b2"}));  // closed by a flow of zero, as the user has asked
  EXPECT_EQ(survey_warnings(s), Names{});
}

TEST(NetworkSurvey, RangesExtentAndWalls) {
  BoundedGraph network = bifurcation({pressure(0, 100), pressure(2, 90)});
  network.graph.wall_thickness = {1e-4, 0, 0};
  network.notes = {"two points were merged"};
  const NetworkSurvey s = survey(network);
  EXPECT_EQ(s.radius.least, 1.5e-3);
  EXPECT_EQ(s.radius.least_vessel, "b1");
  EXPECT_EQ(s.radius.largest_vessel, "t");
  EXPECT_EQ(s.length.largest, 12e-3);
  ASSERT_TRUE(s.extent);
  EXPECT_EQ((*s.extent)[1].second, 5e-3);
  EXPECT_EQ(s.assumed_walls.names, (Names{"b1", "b2"}));
  const std::string lines = all_lines(s);
  EXPECT_TRUE(has(lines, "radius: from 1.5 mm (vessel b1) to 2 mm (vessel t)")) << lines;
  EXPECT_TRUE(has(lines, "extent: 20 mm x 10 mm x 0")) << lines;
  EXPECT_TRUE(has(lines, "the rules of [wall] assume one: b1, b2")) << lines;
  EXPECT_TRUE(has(lines, "note: two points were merged")) << lines;
  network.graph.radius = {1.5e-3, 1.5e-3 * (1 + 1e-12), 1.5e-3};  // as lengths computed from places are
  EXPECT_TRUE(has(all_lines(survey(network)), "radius: 1.5 mm of all vessels"));
}

TEST(NetworkSurvey, PartsAndWhyNothingFlowsInThem) {
  // a-b flows; c-d has one condition; e-f none; g is alone.
  BoundedGraph network{networks::graph(7, {{0, 1}, {2, 3}, {4, 5}}),
                       {pressure(0, 1), inflow(1, -1), pressure(3, 0)}};
  network.graph.radius = network.graph.length = {1e-3, 1e-3, 1e-3};
  network.graph.junction_name = {"a", "b", "c", "d", "e", "f", "g"};
  const NetworkSurvey s = survey(network);
  EXPECT_EQ(s.parts, 3u);
  EXPECT_EQ(s.loops, 0u);
  EXPECT_EQ(s.isolated.names, (Names{"g"}));
  EXPECT_EQ(s.parts_with_one_opening.names, (Names{"c"}));
  EXPECT_EQ(s.parts_without_conditions.names, (Names{"e"}));
  EXPECT_EQ(s.parts_without_pressure.names, (Names{"e"}));
  EXPECT_EQ(s.open_ends.names, (Names{"c"}));
  EXPECT_EQ(s.vessels_without_way, 2u);
  EXPECT_EQ(s.dead_ends.count, 0u);
  EXPECT_EQ(s.without_flow(), 2u);
}

TEST(NetworkSurvey, NamesAtMostFiveAndCountsTheRest) {
  // A trunk with a condition at each end and 100 dead ends at its middle.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> vessels{{0, 1}, {1, 2}};
  for (std::uint32_t j = 3; j < 103; ++j) vessels.emplace_back(1, j);
  BoundedGraph network{networks::graph(103, vessels), {pressure(0, 1), pressure(2, 0)}};
  network.graph.radius = network.graph.length = std::vector<double>(102, 1e-3);
  const NetworkSurvey s = survey(network);
  EXPECT_EQ(s.dead_ends.count, 100u);
  EXPECT_EQ(list_of(s.open_ends), "3, 4, 5, 6, 7 and 95 more");
}
