// SPDX-License-Identifier: BSD-3-Clause
// Networks from CSV and JSON: what is read, what is refused and how.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/network/network_case.hpp"

namespace rhexis::network {
namespace {

class NetworkFiles : public NetworkCase {
 protected:
  BoundedGraph csv(const std::string& junctions, const std::string& vessels) {
    return read_csv_network(write("j.csv", junctions), write("v.csv", vessels), options_);
  }
  BoundedGraph json(const std::string& text) { return read_json_network(write("n.json", text), options_); }

  FileOptions options_{.to_si = to_si};
};

const std::string junctions = "id,x [mm],y [mm],z [mm],pressure [mmHg]\na,0,0,0,10\nb,3,4,0,\nc,3,4,12,0\n";
const std::string vessels = "id,from,to,radius [um]\n1,a,b,50\n2,b,c,40\n";

TEST_F(NetworkFiles, Csv) {
  const BoundedGraph n = csv(junctions, vessels);
  const Graph& g = n.graph;
  ASSERT_EQ(g.junctions, 3u);
  ASSERT_EQ(g.vessels(), 2u);
  EXPECT_DOUBLE_EQ(g.radius[1], 40e-6);
  EXPECT_DOUBLE_EQ(g.length[0], 5e-3);  // the distance of the ends
  EXPECT_DOUBLE_EQ(g.length[1], 12e-3);
  EXPECT_EQ(g.name_of_vessel(1), "2");
  EXPECT_EQ(g.name_of_junction(2), "c");
  EXPECT_EQ(g.kind[0], VesselKind::unknown);
  ASSERT_EQ(n.conditions.size(), 2u);
  EXPECT_DOUBLE_EQ(n.conditions[0].value, 1333.22);
}

TEST_F(NetworkFiles, CsvOfAnyShape) {
  const BoundedGraph n =
      csv("\xef\xbb\xbf# comment\r\n\r\nresistance [Pa s/m3], pressure [mmHg], id, flow [mL/min]\r\n"
          "  2e9 , 5, \"a, \"\"b\"\"\", \r\n,,isolated,\r\n,,c,60\r\n",
          "kind,to,from,length [mm],diameter [um],id,generation,wall_thickness [um]\nvein,c,\"a, "
          "\"\"b\"\"\",2,10,x,3,1.5\n"
          "# the last line has no end\n artery , \"a, \"\"b\"\"\", c, +2e0, 10, y,,");
  EXPECT_EQ(n.graph.junctions, 3u);
  EXPECT_EQ(n.graph.name_of_junction(0), "a, \"b\"");
  EXPECT_DOUBLE_EQ(n.graph.radius[0], 5e-6);
  EXPECT_DOUBLE_EQ(n.graph.wall_thickness[0], 1.5e-6);
  EXPECT_EQ(n.graph.wall_thickness[1], 0);
  EXPECT_EQ(n.graph.kind[0], VesselKind::vein);
  EXPECT_EQ(n.graph.kind[1], VesselKind::artery);
  EXPECT_EQ(n.graph.generation[0], 3);
  EXPECT_EQ(n.graph.generation[1], -1);
  EXPECT_EQ(n.conditions[0].resistance, 2e9);
  EXPECT_NEAR(n.conditions[1].value, 1e-6, 1e-20);
  EXPECT_EQ(n.conditions[1].kind, BoundaryCondition::Kind::flow);
  EXPECT_TRUE(n.graph.x.empty());
}

TEST_F(NetworkFiles, CsvMistakes) {
  struct Mistake {
    std::string j, v;
    std::vector<std::string> fragments;
  };
  const std::string header = "id,from,to,radius [um]\n";
  const std::vector<Mistake> mistakes{
      {"", vessels, {"j.csv", "empty"}},
      {" \n\n", vessels, {"j.csv", "empty"}},
      {std::string("id\na\0b\n", 7), vessels, {"j.csv", "not a text file"}},
      {"# nothing\n", vessels, {"j.csv", "header"}},
      {"x [mm]\n1\n", vessels, {"j.csv:1", "no column id"}},
      {"id,x,y [mm],z [mm]\na,1,2,3\n", vessels, {"j.csv:1", "column x", "x [m]"}},
      {"id,x [kg],y [mm],z [mm]\na,1,2,3\n", vessels, {"j.csv:1", "x [kg]"}},
      {"id,x,y [mm],z [kg]\na,1,2,3\n", vessels, {"2 faults", "j.csv:1: column x", "j.csv:1: column z [kg]"}},
      {vessels, vessels, {"j.csv:1", "a table of vessels"}},
      {"id,id\na,b\n", vessels, {"j.csv:1", "two columns"}},
      {"id\na\nb\na\n", vessels, {"j.csv:4", "id = a", "already"}},
      {"id,x [mm],y [mm],z [mm]\na,1,2\n", vessels, {"j.csv:2", "3 fields", "4", "cut short"}},
      {"id,x [mm],y [mm],z [mm]\na,1,2,\n", vessels, {"j.csv:2", "x, y, z"}},
      {"id,x [mm],y [mm],z [mm]\na,1,2,3\nb,,,\n", vessels, {"j.csv:3", "coordinates"}},
      {"id,pressure [mmHg],flow [mL/min]\na,1,2\n", vessels, {"j.csv:2", "a pressure and a flow"}},
      {"id,resistance [Pa s/m3]\na,1\n", vessels, {"j.csv:2", "resistance", "pressure"}},
      {"id,pressure [mmHg],resistance [Pa s/m3]\na,1,-1\n",
       vessels,
       {"j.csv:2", "resistance of junction a is -1 Pa s/m3: must be at least 0"}},
      {"id,pressure [mmHg]\na,high\n", vessels, {"j.csv:2", "pressure = high"}},
      {"id,pressure [mmHg]\na,nan\n", vessels, {"j.csv:2", "pressure = nan"}},
      {"id\n\"a\n", vessels, {"j.csv:2", "quoted"}},
      {junctions, header + "1,a,b,\"1.5\" cm\n", {"v.csv:2", "after a quoted field, \"1.5\": 'cm'"}},
      {junctions, header, {"v.csv", "no vessels"}},
      {junctions, "id,from,to\n1,a,b\n", {"v.csv:1", "radius"}},
      {junctions, "id,from,to,radius [um],diameter [um]\n", {"v.csv:1", "radius and diameter"}},
      {junctions, header + "1,a,b,0\n", {"v.csv:2", "radius of vessel 1", "at least 1e-12 m"}},
      {junctions, header + "1,a,b,1e-7\n", {"v.csv:2", "radius of vessel 1 is 1e-13 m", "at least 1e-12 m"}},
      {junctions, header + "1,a,b,-5\n", {"v.csv:2", "radius", "-5e-06"}},
      {junctions, header + "1,a,b,1e9\n", {"v.csv:2", "radius of vessel 1 is 1000 m", "at most 100 m"}},
      {junctions, header + "1,a,b,inf\n", {"v.csv:2", "radius = inf"}},
      {junctions, header + "1,a,b,\n", {"v.csv:2", "radius of vessel 1 is missing"}},
      {junctions, header + "1,a,a,5\n", {"v.csv:2", "to itself"}},
      {junctions, header + "1,a,d,5\n", {"v.csv:2", "to = d", "no junction"}},
      {junctions, header + "1,a,b,5\n1,b,c,5\n", {"v.csv:3", "id = 1", "already"}},
      {junctions, header + ",a,b,5\n", {"v.csv:2", "id is missing"}},
      {junctions, header + "1,a,b,5\n2,b,c", {"v.csv:3", "3 fields", "cut short"}},
      {junctions, header + "1,a,b,5,7\n", {"v.csv:2", "5 fields", "4", "comma too many"}},
      {junctions, "id,from,to,radius [um],kind\n1,a,b,5,nerve\n", {"v.csv:2", "kind = nerve", "artery"}},
      {junctions, "id,from,to,radius [um],generation\n1,a,b,5,1.5\n", {"v.csv:2", "generation = 1.5"}},
      {junctions,
       "id,from,to,radius [um],length [mm]\n1,a,b,5,0\n",
       {"v.csv:2", "length", "at least 1e-12 m"}},
      {"id\na\nb\nc\n", vessels, {"v.csv:2", "needs a length"}},
      {"id,x [mm],y [mm],z [mm],pressure [Pa]\na,0,0,0,1\nb,1,0,0,\nc,2,0,0,0\nstray,9,9,9,5000\n",
       vessels,
       {"v.csv", "junction stray", "no vessel's end"}},
  };
  for (const Mistake& m : mistakes) refused([&] { csv(m.j, m.v); }, m.fragments);
  refused([&] { read_csv_network(folder_.path() / "absent.csv", folder_.path() / "v.csv", options_); },
          {"absent.csv"});
}

TEST_F(NetworkFiles, Json) {
  const BoundedGraph n = json(R"({"units": {"length": "mm", "pressure": "mmHg"},
    "junctions": [{"id": "a", "x": 0, "y": 0, "z": 0, "pressure": 10}, {"id": 7, "x": 3, "y": 4, "z": 0}],
    "vessels": [{"id": 1, "from": "a", "to": 7, "diameter": 0.2, "kind": "artery"}]})");
  EXPECT_DOUBLE_EQ(n.graph.radius[0], 1e-4);
  EXPECT_DOUBLE_EQ(n.graph.length[0], 5e-3);
  EXPECT_EQ(n.graph.name_of_junction(1), "7");
  EXPECT_DOUBLE_EQ(n.conditions[0].value, 1333.22);
}

TEST_F(NetworkFiles, JsonMistakes) {
  const auto with = [](const std::string& vessel) {
    return R"({"units": {"length": "mm"}, "junctions": [{"id": "a"}, {"id": "b"}], "vessels": [)" + vessel +
           "]}";
  };
  const std::vector<std::pair<std::string, std::vector<std::string>>> mistakes{
      {"{\"units\": {},\n \"junctions\": [", {"n.json:2", "cut short"}},
      {"[]", {"n.json", "an object"}},
      {"{}", {"junctions", "a list"}},
      {R"({"units": {"length": "kg"}})", {"units.length", "kg"}},
      {R"({"units": {"length": 1}})", {"units.length"}},
      {R"({"junctions": [1], "vessels": []})", {"junctions[0]", "an object"}},
      {with(R"({"id": 1, "from": "a", "to": "b", "radius": 1e999})"), {"n.json", "1e999"}},
      {with(""), {"no vessels"}},
      {with(R"({"id": 1, "from": "a", "to": "b", "radius": -1, "length": 1})"),
       {"vessels[0]", "radius", "at least 1e-12 m"}},
      {with(R"({"id": 1, "from": "a", "to": "b", "radius": "1", "length": 1})"),
       {"vessels[0].radius", "number"}},
      {with(R"({"id": 1, "from": "a", "to": "b", "length": 1},
                {"id": 2, "from": "a", "to": "b", "radius": 1, "length": 1})"),
       {"vessels[0]", "radius", "missing"}},
      {with(R"({"id": 1, "from": "a", "to": "b", "radii": [1, 2], "length": 1})"),
       {"no member of vessels is called radius or diameter; members that are not known: radii"}},
      {with(R"({"id": 1, "from": "a", "to": "c", "radius": 1, "length": 1})"), {"vessels[0]", "to = c"}},
      {with(R"({"id": 1, "from": "a", "to": "b", "radius": 1, "Radius": 1, "length": 1})"),
       {"vessels[0]", "two members mean the radius"}},
      {with(R"({"id": 1.5, "from": "a", "to": "b", "radius": 1, "length": 1})"), {"vessels[0].id", "1.5"}},
      {with(R"({"id": 1, "to": "b", "radius": 1, "length": 1})"), {"vessels[0]: from is missing"}},
      {R"({"junctions": [{"id": 1}, {"id": 2}], "vessels": [{"id": 1, "from": 1, "to": 2, "radius": 1, "length": 1}]})",
       {"vessels[0].radius", "units.length"}},
  };
  for (const auto& [text, fragments] : mistakes) refused([&, t = text] { json(t); }, fragments);
}

TEST_F(NetworkFiles, KindsOfFiles) {
  for (const std::vector<std::string>& files :
       {std::vector<std::string>{"a.csv"}, {"a.json", "b.json"}, {"a.txt"}, {"a.csv", "b.csv", "c.csv"}}) {
    Parameters parameters;
    parameters.files = files;
    refused([&] { read_network(parameters, to_si); }, {"one .json", ".vtp", "two .csv"});
  }
}

}  // namespace
}  // namespace rhexis::network
