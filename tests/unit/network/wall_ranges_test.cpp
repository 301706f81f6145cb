// SPDX-License-Identifier: BSD-3-Clause
// Walls by ranges of radius, for vessels of which a network's files tell no thickness.
#include "network/repair/wall_ranges.hpp"

#include "unit/network/network_case.hpp"

namespace rhexis::network {
namespace {

using WallRanges = NetworkCase;

/// Vessels of radii 5, 10, 10, 20 and 30 um; the last knows its wall, and the third is a vein.
const std::vector<std::pair<std::string, std::string>> files{
    {"j.csv", "id,pressure [mmHg]\na,30\nb,10\n"},
    {"v.csv",
     "id,from,to,radius [um],length [um],wall_thickness [um],kind\n1,a,b,5,500,,\n2,a,b,10,500,,artery\n"
     "3,a,b,10,500,,vein\n4,a,b,20,500,,\n5,a,b,30,500,7,\n"}};

std::vector<double> walls_in_um(const BoundedGraph& network) {
  std::vector<double> walls = network.graph.wall_thickness;
  for (double& wall : walls) wall *= 1e6;
  return walls;
}

TEST_F(WallRanges, GiveThicknessesWhereTheFilesTellNone) {
  struct Case {
    std::vector<WallRange> ranges;
    std::vector<double> walls;  ///< um; 0: the rules of [wall] assume it
    std::string note;
  };
  for (const Case& c : std::vector<Case>{
           {{}, {0, 0, 0, 0, 7}, ""},
           {{{.ratio = 0.1}},
            {0.5, 1, 1, 2, 7},
            "wall_range[1] gives the walls of 4 vessels of radius from 0 m"},
           // A limit belongs to the range above it, also where 10 um is 9.999999999999999e-06 m.
           {{{.radius_to = 10e-6, .thickness = 1e-6},
             {.radius_from = 10e-6, .radius_to = 20e-6, .ratio = 0.3}},
            {1, 3, 3, 0, 7},
            "wall_range[2] gives the walls of 2 vessels of radius from 10 um to 20 um: 0.3 of the radius"},
           {{{.kind = "vein", .thickness = 2e-6}, {.radius_from = 6e-6, .kind = "artery", .thickness = 4e-6}},
            {0, 4, 2, 4, 7},
            "wall_range[1] gives the walls of 1 vessel of radius from 0 m, kind vein: 2 um"},
           {{{.radius_from = 1e-3, .ratio = 0.1}}, {0, 0, 0, 0, 7}, "walls of 0 vessels"}}) {
    Parameters p;
    p.wall_ranges = c.ranges;
    const BoundedGraph n = network(files, p);
    const std::vector<double> walls = walls_in_um(n);
    ASSERT_EQ(walls.size(), c.walls.size());
    for (std::size_t v = 0; v < walls.size(); ++v) EXPECT_NEAR(walls[v], c.walls[v], 1e-12) << v;
    EXPECT_EQ(n.notes.size(), c.ranges.size());
    EXPECT_NE(notes_of(n).find(c.note), std::string::npos) << notes_of(n);
  }
}

TEST_F(WallRanges, ThatDoNotFitAreRefusedWithTheirKey) {
  const WallRange thin{.radius_to = 10e-6, .thickness = 1e-6};
  const auto from = [](double radius, const char* kind = "") {
    return WallRange{.radius_from = radius, .kind = kind, .ratio = 0.2};
  };
  const std::vector<std::pair<std::vector<WallRange>, std::pair<std::string, std::string>>> mistakes{
      {{{.radius_to = 1e-5}}, {"wall_range[1].thickness", "one of"}},
      {{thin, {.thickness = 1e-6, .ratio = 0.1}}, {"wall_range[2].thickness", "one of"}},
      {{{.radius_from = 2e-5, .radius_to = 1e-5, .ratio = 0.1}}, {"wall_range[1].radius_to", "above"}},
      {{thin, from(9e-6)}, {"wall_range[2].radius_from", "overlaps with wall_range[1], radii below 10 um"}},
      {{from(11e-6), thin}, {"wall_range[1].radius_from", "leaves a gap above wall_range[2]"}},
      {{from(0), from(5e-6)}, {"wall_range[2].radius_from", "overlaps with wall_range[1]"}},
      {{thin, from(9e-6, "vein")}, {"wall_range[2].radius_from", "overlaps"}},
  };
  for (const auto& [ranges, expected] : mistakes)
    refused([&, r = ranges] { check(r); }, {expected.second}, expected.first);
  EXPECT_NO_THROW(check({from(10e-6), thin}));
  EXPECT_NO_THROW(check({from(0, "artery"), from(5e-6, "vein")}));
}

}  // namespace
}  // namespace rhexis::network
