// SPDX-License-Identifier: BSD-3-Clause
// A vessel is a branch of the centre lines: what lies between junctions where lines meet or end.
#include <gtest/gtest.h>

#include <limits>

#include "network/lines/line_network.hpp"
#include "network/names.hpp"
#include "network/repair/drop.hpp"

namespace rhexis::network {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Lines through points, with the radii and pressures of these.
vtp::Lines drawing(const std::vector<Point>& points, const std::vector<std::vector<std::int64_t>>& lines,
                   std::vector<double> radii, std::vector<double> pressures) {
  vtp::Lines all;
  for (const Point& p : points) all.coordinates.insert(all.coordinates.end(), p.begin(), p.end());
  for (const std::vector<std::int64_t>& line : lines) {
    all.connectivity.insert(all.connectivity.end(), line.begin(), line.end());
    all.offsets.push_back(static_cast<std::int64_t>(all.connectivity.size()));
  }
  all.point_arrays = {{"radius", 1, false, std::move(radii)},
                      {"pressure_condition", 1, false, std::move(pressures)}};
  return all;
}

/// A Y of three lines: a trunk of which a second line continues the first, and two arms. Points 1 mm apart
/// along the trunk 0, 1, 2, 3, 4; arms 4, 5, 6 and 4, 7.
vtp::Lines fork(std::vector<std::vector<std::int64_t>> lines, double pressure_at_2 = nan) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0},
                                  {4, 0, 0}, {5, 1, 0}, {6, 1, 0}, {5, -1, 0}};
  return drawing(points, lines, {2, 2, 1, 1, 1, 0.5, 0.5, 0.5},
                 {100, nan, pressure_at_2, nan, nan, nan, 0, 0});
}

TEST(LineBranches, SegmentsBetweenJunctionsAreOneVessel) {
  struct Case {
    const char* name;
    vtp::Lines lines;
  };
  const Case cases[] = {
      {"the trunk in one line", fork({{0, 1, 2, 3, 4}, {4, 5, 6}, {4, 7}})},
      {"a line continues another", fork({{0, 1, 2}, {2, 3, 4}, {4, 5, 6}, {4, 7}})},
      {"and against its direction", fork({{0, 1, 2}, {4, 3, 2}, {4, 5, 6}, {4, 7}})},
  };
  for (const Case& c : cases) {
    const Graph g = network_of_lines(c.lines, "n.vtp", 1e-3, 0).graph;
    ASSERT_EQ(g.vessels(), 3u) << c.name;
    EXPECT_EQ(g.junctions, 4u) << c.name;
    EXPECT_EQ(find_vessel(g, "0"), 0u) << c.name;
    ASSERT_EQ(g.pieces(0).size(), c.lines.lines() == 3 ? 4u : 3u) << c.name;
    EXPECT_NEAR(g.length[0], 4e-3, 1e-16) << c.name;
    double length = 0;
    for (const VesselPiece& p : g.pieces(0)) length += p.length;
    EXPECT_NEAR(length, 4e-3, 1e-16) << c.name;
    EXPECT_EQ(g.pieces(0)[0].radius, 2e-3) << c.name;
    EXPECT_NEAR(g.pieces(0)[1].radius, 1e-3 * tapered_radius(2, 1), 1e-18) << c.name;
    EXPECT_EQ(g.pieces(0).back().radius, 1e-3) << c.name;
    EXPECT_EQ(g.pieces(0)[2].start, (Point{2e-3, 0, 0})) << c.name;
    EXPECT_EQ(g.radius_at(0, g.from[0]), 2e-3) << c.name;
    EXPECT_EQ(g.radius_at(0, g.to[0]), 1e-3) << c.name;
    EXPECT_GT(g.radius[0], 1e-3) << c.name;
    EXPECT_LT(g.radius[0], 2e-3) << c.name;
    EXPECT_EQ(g.pieces(1).size(), 2u) << c.name;
    EXPECT_EQ(g.pieces(2).size(), 0u) << c.name;
  }
}

TEST(LineBranches, ConditionsAndCellValuesDivideVessels) {
  const auto count = [](const vtp::Lines& lines) {
    return network_of_lines(lines, "n.vtp", 1e-3, 0).graph.vessels();
  };
  EXPECT_EQ(count(fork({{0, 1, 2, 3, 4}, {4, 5, 6}, {4, 7}}, 50)), 4u);
  vtp::Lines walls = fork({{0, 1, 2}, {2, 3, 4}, {4, 5, 6}, {4, 7}});
  walls.cell_arrays.push_back({"wall_thickness", 1, false, {0.2, 0.1, 0.1, 0.1}});
  EXPECT_EQ(count(walls), 4u);
  walls.cell_arrays[0].values[0] = 0.1;
  EXPECT_EQ(count(walls), 3u);
}

TEST(LineBranches, LinesOfTwoPointsAreVesselsAsTheyAre) {
  const Graph g =
      network_of_lines(fork({{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {4, 7}}), "n.vtp", 1e-3, 0)
          .graph;
  EXPECT_EQ(g.vessels(), 7u);
  EXPECT_TRUE(g.piece.empty());
}

TEST(LineBranches, RingsAreNoVesselFromAJunctionToItself) {
  // A trunk with a ring at its end.
  const vtp::Lines lines = drawing({{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {2, -1, 0}, {0, 1, 0}},
                                   {{0, 1, 2, 3, 1}, {4, 0}}, {1, 2, 1, 2, 1}, {nan, nan, nan, nan, 100});
  const Graph g = network_of_lines(lines, "n.vtp", 1e-3, 0).graph;
  for (std::size_t v = 0; v < g.vessels(); ++v) EXPECT_NE(g.from[v], g.to[v]);
  EXPECT_EQ(g.vessels(), 4u);
}

TEST(LineBranches, PiecesStayWithTheirVessels) {
  BoundedGraph n = network_of_lines(fork({{0, 1, 2, 3, 4}, {4, 7}, {4, 5, 6}}), "n.vtp", 1e-3, 0);
  keep_vessels(n, {false, true, true});
  EXPECT_EQ(n.graph.pieces(0).size(), 0u);
  ASSERT_EQ(n.graph.pieces(1).size(), 2u);
  EXPECT_EQ(n.graph.pieces(1)[1].radius, 0.5e-3);
}

}  // namespace
}  // namespace rhexis::network
