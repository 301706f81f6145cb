// SPDX-License-Identifier: BSD-3-Clause
// Centre lines as tools write them: repeated trunks, other samplings, jitter and gaps lead to the flow of the
// network drawn once; lines without any of these stay as they are.
#include "network/lines/line_merging.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/error.hpp"
#include "network/lines/line_network.hpp"

namespace rhexis::network {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inlet_pressure = 13332, outlet_pressure = 12000;  // Pa
constexpr double viscosity = 3.5e-3;                               // Pa s

/// A point of a line in mm, with the radius there and the pressure, if any is known.
struct Sample {
  Point position;
  double radius;
  double pressure = nan;
};
using Line = std::vector<Sample>;

vtp::Lines drawing(const std::vector<Line>& lines) {
  vtp::Lines all;
  vtp::Array radius{"MaximumInscribedSphereRadius", 1, false, {}},
      pressure{"pressure_condition", 1, false, {}};
  for (const Line& line : lines) {
    for (const Sample& sample : line) {
      all.connectivity.push_back(static_cast<std::int64_t>(radius.values.size()));
      all.coordinates.insert(all.coordinates.end(), sample.position.begin(), sample.position.end());
      radius.values.push_back(sample.radius);
      pressure.values.push_back(sample.pressure);
    }
    all.offsets.push_back(static_cast<std::int64_t>(all.connectivity.size()));
  }
  all.point_arrays = {radius, pressure};
  return all;
}

BoundedGraph read(const vtp::Lines& lines, double tolerance = default_merge_tolerance) {
  return network_of_lines(lines, "n.vtp", 1e-3, tolerance);
}

/// Flow out of the inlet (m3/s) with Poiseuille's law in every vessel: Kirchhoff's law by Gauss elimination.
double inflow(const BoundedGraph& network) {
  const Graph& g = network.graph;
  const std::size_t n = g.junctions;
  std::vector<std::vector<double>> a(n, std::vector<double>(n + 1));
  std::vector<double> fixed(n, nan), conductance(g.vessels());
  for (const BoundaryCondition& c : network.conditions) fixed[c.junction] = c.value;
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    double resistance = 0;
    g.for_each_piece(v, [&](double radius, double length) {
      resistance += 8 * viscosity * length / (std::numbers::pi * std::pow(radius, 4));
    });
    conductance[v] = 1 / resistance;
    for (const auto& [i, j] : {std::pair(g.from[v], g.to[v]), std::pair(g.to[v], g.from[v])}) {
      a[i][i] += conductance[v];
      a[i][j] -= conductance[v];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isnan(fixed[i])) continue;
    std::fill(a[i].begin(), a[i].end(), 0);
    a[i][i] = 1;
    a[i][n] = fixed[i];
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; factor != 0 && j <= n; ++j) a[i][j] -= factor * a[k][j];
    }
  }
  std::vector<double> p(n);
  for (std::size_t i = n; i-- > 0;) {
    p[i] = a[i][n];
    for (std::size_t j = i + 1; j < n; ++j) p[i] -= a[i][j] * p[j];
    p[i] /= a[i][i];
  }
  double sum = 0;
  for (std::size_t v = 0; v < g.vessels(); ++v) {
    if (fixed[g.from[v]] == inlet_pressure) sum += conductance[v] * (p[g.from[v]] - p[g.to[v]]);
    if (fixed[g.to[v]] == inlet_pressure) sum += conductance[v] * (p[g.to[v]] - p[g.from[v]]);
  }
  return sum;
}

double litres_per_minute(const BoundedGraph& network) {
  return inflow(network) * 6e4;
}

/// A trunk of 10 mm along z in steps of a mm, radius 2 mm; `shift`: of all but the inlet, mm.
Line trunk(double shift = 0, double step = 1, double radius = 2) {
  Line line{{{0, 0, 0}, radius, inlet_pressure}};
  const int steps = static_cast<int>(std::round(10 / step));
  for (int i = 1; i <= steps; ++i) line.push_back({{shift * (i % 2 == 0 ? 1 : -1), shift, i * step}, radius});
  return line;
}

/// A branch of 10 mm from the trunk's end, radius 1.5 mm, towards angle a about z, without its first point.
Line branch(double a, double step = 1) {
  Line line;
  const int steps = static_cast<int>(std::round(10 / step));
  for (int i = 1; i <= steps; ++i)
    line.push_back({{0.6 * i * step * std::cos(a), 0.6 * i * step * std::sin(a), 10 + 0.8 * i * step}, 1.5});
  line.back().pressure = outlet_pressure;
  return line;
}

Line joined(Line a, const Line& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The trunk once, and `outlets` branches that begin at its last point.
std::vector<Line> once(int outlets) {
  std::vector<Line> lines{trunk()};
  for (int k = 0; k < outlets; ++k)
    lines.push_back(joined({trunk().back()}, branch(2 * std::numbers::pi * k / outlets)));
  return lines;
}

/// A line from the inlet to every outlet, as vmtk writes them.
std::vector<Line> overlapping(int outlets, double jitter) {
  std::vector<Line> lines;
  for (int k = 0; k < outlets; ++k)
    lines.push_back(joined(trunk(k * jitter), branch(2 * std::numbers::pi * k / outlets)));
  return lines;
}

TEST(LineMerging, RepeatedTrunksCarryTheFlowOfOne) {
  struct Case {
    const char* name;
    int outlets;
    double jitter;     // mm
    double flow;       // L/min
    double tolerance;  // relative, on the flow of the lines drawn once
  };
  const Case cases[] = {
      {"two outlets", 2, 0, 5.708, 1e-14},         {"five outlets", 5, 0, 8.937, 1e-14},
      {"a nanometre apart", 5, 1e-6, 8.937, 1e-6}, {"a micrometre apart", 2, 1e-3, 5.708, 1e-3},
      {"20 um apart", 3, 1e-2, 7.141, 1e-2},
  };
  for (const Case& c : cases) {
    const BoundedGraph truth = read(drawing(once(c.outlets)));
    const BoundedGraph merged = read(drawing(overlapping(c.outlets, c.jitter)));
    EXPECT_NEAR(litres_per_minute(truth), c.flow, 6e-4) << c.name;
    EXPECT_NEAR(inflow(merged) / inflow(truth), 1, c.tolerance) << c.name;
    EXPECT_EQ(merged.graph.vessels(), truth.graph.vessels()) << c.name;
    EXPECT_EQ(merged.conditions.size(), truth.conditions.size()) << c.name;
    EXPECT_TRUE(truth.notes.empty()) << c.name << truth.notes.front();
    ASSERT_EQ(merged.notes.size(), 1u) << c.name;
    EXPECT_NE(merged.notes[0].find(std::to_string(10 * (c.outlets - 1)) + " segments of"), std::string::npos)
        << merged.notes[0];
  }
}

TEST(LineMerging, AnotherSamplingIsTheSameTrunk) {
  const BoundedGraph truth = read(drawing(once(2)));
  for (const double step : {10.0 / 33, 10.0 / 14, 2.5, 10.0 / 3}) {
    const double pi = std::numbers::pi;
    const BoundedGraph merged =
        read(drawing({joined(trunk(), branch(0)), joined(trunk(0, step), branch(pi))}));
    EXPECT_NEAR(inflow(merged) / inflow(truth), 1, 1e-12) << step;
    const BoundedGraph reversed =
        read(drawing({joined(trunk(0, step), branch(0)), joined(trunk(), branch(pi))}));
    EXPECT_NEAR(inflow(reversed) / inflow(truth), 1, 1e-2) << step;
  }
}

TEST(LineMerging, LinesMeetWhereTheyPart) {
  // The second line leaves the first one, which has no point there, at x = 5.
  const Line straight{{{0, 0, 0}, 1, inlet_pressure}, {{10, 0, 0}, 1}, {{20, 0, 0}, 1, outlet_pressure}};
  const Line leaving{
      {{0, 0, 0}, 1, inlet_pressure}, {{2.5, 0, 0}, 1}, {{5, 0, 0}, 1}, {{5, 8, 0}, 1, outlet_pressure}};
  const Graph g = read(drawing({straight, leaving})).graph;
  ASSERT_EQ(g.vessels(), 3u);
  std::vector<double> lengths = g.length;
  std::ranges::sort(lengths);
  EXPECT_NEAR(lengths[0], 5e-3, 1e-15);
  EXPECT_NEAR(lengths[1], 8e-3, 1e-15);
  EXPECT_NEAR(lengths[2], 15e-3, 1e-15);
}

TEST(LineMerging, GapsAtBranchPointsAreClosed) {
  struct Case {
    double gap;  // mm
    bool closed;
  };
  // The tolerance is 0.05 of the branch's radius, 1.5 mm.
  for (const Case& c :
       {Case{0, true}, Case{1e-6, true}, Case{1e-3, true}, Case{0.07, true}, Case{0.2, false}}) {
    Line first = joined({trunk().back()}, branch(0)),
         second = joined({trunk().back()}, branch(std::numbers::pi));
    first[0].radius = second[0].radius = 1.5;
    second[0].position[2] += c.gap;
    const BoundedGraph network = read(drawing({trunk(), first, second}));
    const std::string notes = network.notes.empty() ? "" : network.notes[0];
    if (c.closed) {
      EXPECT_NEAR(litres_per_minute(network), c.gap > 0.01 ? 5.59 : 5.560, c.gap > 0.01 ? 0.03 : 6e-4)
          << c.gap;
      EXPECT_EQ(notes.empty(), c.gap == 0) << notes;
    } else {
      EXPECT_EQ(network.graph.junctions, 4u);
      EXPECT_NE(notes.find("point 22 ends 120 um from cell 1"), std::string::npos) << notes;
    }
  }
}

TEST(LineMerging, AnEndBesideASegmentCutsIt) {
  const Line trunk{{{0, 0, 0}, 2, inlet_pressure}, {{20, 0, 0}, 2, outlet_pressure}};
  const Line side{{{7, 0.01, 0}, 1}, {{7, 10, 0}, 1, outlet_pressure}};
  const BoundedGraph network = read(drawing({trunk, side}));
  ASSERT_EQ(network.graph.vessels(), 3u);
  EXPECT_NEAR(network.graph.length[0], 7e-3, 1e-7);
  EXPECT_NEAR(network.graph.length[1], 13e-3, 1e-7);
  EXPECT_DOUBLE_EQ(network.graph.radius[0], 2e-3);
  EXPECT_DOUBLE_EQ(network.graph.radius[2], 1e-3);
}

TEST(LineMerging, PartsOfANetworkMeetAtTheirJunctions) {
  // Two lines end at one place, two begin 1 nm further on.
  const auto line = [](Point a, Point b, double pa, double pb) { return Line{{a, 1, pa}, {b, 1, pb}}; };
  const BoundedGraph network = read(drawing({line({0, 3, 0}, {5, 0, 0}, inlet_pressure, nan),
                                             line({0, -3, 0}, {5, 0, 0}, inlet_pressure, nan),
                                             line({5 + 1e-6, 0, 0}, {9, 3, 0}, nan, outlet_pressure),
                                             line({5 + 1e-6, 0, 0}, {9, -3, 0}, nan, outlet_pressure)}));
  EXPECT_EQ(network.graph.junctions, 5u);
}

TEST(LineMerging, ConditionsOfARepetitionAreKept) {
  std::vector<Line> lines = overlapping(2, 0);
  lines[0][0].pressure = nan;
  EXPECT_NEAR(litres_per_minute(read(drawing(lines))), 5.708, 6e-4);
  lines[0][0].pressure = inlet_pressure + 1;
  EXPECT_THROW(read(drawing(lines)), InputError);
}

TEST(LineMerging, GoodLinesStayAsTheyAre) {
  // Finely sampled branches, whose first points are near each other and near the trunk, a dead end that is
  // shorter than the tolerance of the trunk beside it, two lines that cross, and parallel vessels.
  const Line stub{{{0, 0, 10}, 2}, {{0.05, 0, 10}, 0.05}};
  const std::vector<Line> lines{
      trunk(0, 0.01),
      joined({trunk().back()}, branch(0, 0.01)),
      joined({trunk().back()}, branch(1, 0.01)),
      stub,
      {{{-5, 0, 5}, 1, outlet_pressure}, {{5, 0, 5}, 1}, {{5, 0, 7}, 1}, {{5, 0, 9}, 1, inlet_pressure}},
      {{{5, 0, 5}, 1}, {{5, 0, 7}, 1}},
      {{{0, 9, 0}, 1, inlet_pressure}, {{0, 9, 9}, 1, outlet_pressure}},
      {{{0, 9, 0}, 1, inlet_pressure}, {{0, 9, 9}, 1, outlet_pressure}}};
  std::vector<Line> without_copy = lines;
  without_copy.erase(without_copy.begin() + 5);
  const BoundedGraph network = read(drawing(without_copy)), exact = read(drawing(without_copy), 0);
  EXPECT_TRUE(network.notes.empty()) << network.notes.front();
  EXPECT_EQ(network.graph.from, exact.graph.from);
  EXPECT_EQ(network.graph.to, exact.graph.to);
  EXPECT_EQ(network.graph.length, exact.graph.length);
  EXPECT_EQ(network.graph.radius, exact.graph.radius);
  EXPECT_EQ(network.graph.piece.size(), 2u * 1000);
  EXPECT_EQ(network.graph.vessels(), 1u + 2 + 1 + 1 + 2);
  // A line of two points on a segment of a longer line is a copy of it.
  EXPECT_EQ(read(drawing(lines)).notes.size(), 1u);
}

}  // namespace
}  // namespace rhexis::network
