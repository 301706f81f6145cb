// SPDX-License-Identifier: BSD-3-Clause
// What is done to a network after it is read: conditions of the input, parts that are left out; and what is
// told of slips in it.
#include "network/repair/drop.hpp"
#include "network/repair/end_conditions.hpp"
#include "network/survey/plausibility.hpp"
#include "unit/network/network_case.hpp"

namespace rhexis::network {
namespace {

using Repair = NetworkCase;
using Kind = BoundaryCondition::Kind;

/// a - b - c with pressures at a and c; a side branch b - d - e; an island f - g - h, a ring.
const std::vector<std::pair<std::string, std::string>> files{
    {"j.csv",
     "id,x [mm],y [mm],z [mm],pressure "
     "[mmHg],haematocrit\na,0,0,0,30,0.4\nb,1,0,0,,\nc,2,0,0,10,\nd,1,1,0,,\ne,1,2,0,,\n"
     "f,9,0,0,,\ng,9,1,0,,\nh,9,1,1,,\n"},
    {"v.csv",
     "id,from,to,radius [um]\n1,a,b,10\n2,d,b,11\n3,b,c,12\n4,d,e,13\n5,f,g,14\n6,g,h,15\n7,h,f,16\n"}};

std::vector<std::string> vessels_of(const BoundedGraph& network) {
  return network.graph.vessel_name;
}

TEST_F(Repair, LeavesOutIslandsAndDeadEnds) {
  struct Case {
    std::vector<std::string> drop, vessels;
    std::size_t junctions;
  };
  for (const Case& c : std::vector<Case>{{{}, {"1", "2", "3", "4", "5", "6", "7"}, 8},
                                         {{"islands"}, {"1", "2", "3", "4"}, 5},
                                         {{"dead_ends"}, {"1", "3", "5", "6", "7"}, 6},
                                         {{"dead_ends", "islands"}, {"1", "3"}, 3}}) {
    Parameters p;
    p.drop = c.drop;
    const BoundedGraph n = network(files, p);
    EXPECT_EQ(vessels_of(n), c.vessels);
    EXPECT_EQ(n.graph.junctions, c.junctions);
    EXPECT_EQ(n.graph.x.size(), c.junctions);
    EXPECT_EQ(n.notes.size(), c.drop.size()) << notes_of(n);
    ASSERT_EQ(n.conditions.size(), 2u);
    EXPECT_EQ(n.graph.name_of_junction(n.conditions[1].junction), "c");
    const auto v = static_cast<std::size_t>(std::ranges::find(c.vessels, "3") - c.vessels.begin());
    EXPECT_DOUBLE_EQ(n.graph.radius[v], 12e-6);
    EXPECT_EQ(n.graph.name_of_junction(n.graph.from[v]), "b");
    EXPECT_EQ(n.vessel_line[v], 4u);
  }
}

TEST_F(Repair, NamesWhatHasNoneBeforeNumbersChange) {
  BoundedGraph n;
  n.graph.junctions = 3;
  n.graph.from = {0, 1};
  n.graph.to = {1, 2};
  n.graph.radius = n.graph.length = {1e-4, 2e-4};
  n.conditions = {{.junction = 1, .value = 1}, {.junction = 2, .value = 2}};
  keep_vessels(n, {false, true});
  EXPECT_EQ(n.graph.name_of_vessel(0), "1");
  EXPECT_EQ(n.graph.name_of_junction(0), "1");
  EXPECT_EQ(n.graph.from, std::vector<std::uint32_t>{0});
  EXPECT_EQ(n.conditions[1].junction, 1u);
  n.conditions = {};
  drop_islands(n);
  EXPECT_EQ(n.graph.vessels(), 1u);
  refused([&] { drop_dead_ends(n); }, {"leaves no vessel"}, "network.drop");
}

TEST_F(Repair, ConditionsOfTheInputOverrideOrAdd) {
  Parameters p;
  p.conditions = {{.junction = "a", .flow = 1e-12},
                  {.nearest = {1e-3, 2.1e-3, 0}, .pressure = 700, .resistance = 5, .haematocrit = 0.3},
                  {.junction = "c", .haematocrit = 0.2}};
  p.drop = {"islands"};
  const BoundedGraph n = network(files, p);
  ASSERT_EQ(n.conditions.size(), 3u);
  EXPECT_EQ(n.conditions[0].kind, Kind::flow);
  EXPECT_EQ(n.conditions[0].value, 1e-12);
  EXPECT_EQ(n.conditions[0].haematocrit, 0.4);
  EXPECT_DOUBLE_EQ(n.conditions[1].value, 1333.22);
  EXPECT_EQ(n.conditions[1].haematocrit, 0.2);
  EXPECT_EQ(n.graph.name_of_junction(n.conditions[2].junction), "e");
  EXPECT_EQ(n.conditions[2].value, 700);
  EXPECT_EQ(n.conditions[2].resistance, 5);
  EXPECT_EQ(n.conditions[2].haematocrit, 0.3);
}

TEST_F(Repair, ConditionsThatDoNotFitAreRefusedWithTheirKey) {
  const EndCondition a{.junction = "a", .pressure = 1};
  const std::vector<std::pair<std::vector<EndCondition>, std::pair<std::string, std::string>>> mistakes{
      {{{.pressure = 1}}, {"condition[1].junction", "one of condition.junction and condition.nearest"}},
      {{a, {.junction = "a", .nearest = {0, 0, 0}, .pressure = 1}}, {"condition[2].junction", "one of"}},
      {{{.nearest = {0, 0}, .pressure = 1}}, {"condition[1].nearest", "three coordinates"}},
      {{{.junction = "a", .pressure = 1, .flow = 1}}, {"condition[1].flow", "not both"}},
      {{{.junction = "a", .flow = 1, .resistance = 1}}, {"condition[1].resistance", "pressure"}},
      {{{.junction = "a"}}, {"condition[1].junction", "a haematocrit"}},
      {{a, {.junction = "q", .pressure = 1}}, {"condition[2].junction", "no junction"}},
      {{a, {.nearest = {-1, 0, 0}, .pressure = 1}},
       {"condition[2].nearest", "junction a has a condition already, of condition[1]"}},
      {{{.junction = "b", .haematocrit = 0.1}}, {"condition[1].haematocrit", "neither"}},
      {{a, {.junction = "b", .pressure = -2e6}},
       {"condition[2].pressure", "a pressure of -1.5e+04 mmHg, beyond 7501 mmHg"}},
      {{{.junction = "b", .flow = -1}}, {"condition[1].flow", "a flow of -6e+04 L/min, beyond 1000 L/min"}},
  };
  for (const auto& [conditions, expected] : mistakes) {
    Parameters p;
    p.conditions = conditions;
    refused(
        [&] {
          check(p.conditions);
          network(files, p);
        },
        {expected.second}, expected.first);
  }
  Parameters p;
  p.conditions = {{.nearest = {0, 0, 0}, .pressure = 1}};
  refused(
      [&] {
        network({{"j.csv", "id\na\nb\n"}, {"v.csv", "id,from,to,radius [um],length [um]\n1,a,b,5,50\n"}}, p);
      },
      {"needs coordinates"}, "condition[1].nearest");
}

/// One vessel of radius and length (m) along x between junctions that are `distance` apart.
BoundedGraph vessel(double radius, double length, double distance, double pressure = 1000) {
  BoundedGraph n;
  n.file = "v.csv";
  n.vessel_line = {2};
  n.graph.junctions = 2;
  n.graph.x = {0, distance};
  n.graph.y = n.graph.z = {0, 0};
  n.graph.from = {0};
  n.graph.to = {1};
  n.graph.radius = {radius};
  n.graph.length = {length};
  n.conditions = {{.junction = 0, .value = pressure}};
  return n;
}

TEST_F(Repair, SlipsAreTold) {
  struct Case {
    BoundedGraph network;
    std::string sentence;
  };
  for (const Case& c : std::vector<Case>{
           {vessel(12e-3, 0.3, 0.3), ""},  // an aorta
           {vessel(2e-6, 60e-6, 59e-6), ""},
           {vessel(1e-3, 0.0992, 0.1), ""},  // rounded
           {vessel(40e-3, 0.3, 0.3), "v.csv:2: vessel 0: radius 40 mm, wider than any vessel, above 30 mm"},
           {vessel(0.9e-6, 0.3, 0.3),
            "v.csv:2: vessel 0: radius 900 nm, narrower than capillaries, below 1 um"},
           {vessel(1e-3, 0.05, 0.1), "length 50 mm, but its ends are 100 mm apart"},
           {vessel(5e-3, 2e-3, 2e-3), "length 2 mm, below the radius, 5 mm"},
           {vessel(2e-6, 2e-5, 2e-5, 100 * 133.322),
            "junction 0: 100 mmHg at the end of a vessel narrower than 20 um"}}) {
    const Improbable found = improbable(c.network);
    std::vector<std::string> sentences = found.warnings;
    sentences.insert(sentences.end(), found.notes.begin(), found.notes.end());
    ASSERT_EQ(sentences.size(), c.sentence.empty() ? 0u : 1u) << sentences.back();
    if (!c.sentence.empty()) {
      EXPECT_NE(sentences[0].find(c.sentence), std::string::npos) << sentences[0];
    }
  }
  refused([&] { improbable(vessel(1e-3, 1e-4, 0.1)); },
          {"v.csv:2: vessel 0: length 100 um, but its ends are 100 mm apart"});
  // A branch in two pieces.
  BoundedGraph n = vessel(5e-3, 2e-3, 2e-3);
  n.graph.junctions = 3;
  n.graph.x = {0, 2e-3, 4e-3}, n.graph.y = n.graph.z = {0, 0, 0};
  n.graph.from = {0, 1}, n.graph.to = {1, 2}, n.graph.radius = {5e-3, 5e-3}, n.graph.length = {2e-3, 2e-3};
  EXPECT_EQ(improbable(n).warnings.size(), 1u);
  n.graph.radius = {3e-3, 3e-3};
  EXPECT_EQ(improbable(n).warnings.size(), 0u);
}

}  // namespace
}  // namespace rhexis::network
