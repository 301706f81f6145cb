// SPDX-License-Identifier: BSD-3-Clause
// Networks as graphs of images, spreadsheets and other solvers write them: read right, or refused with the
// reason.
#include <cmath>

#include "unit/network/network_case.hpp"

namespace rhexis::network {
namespace {

using Files = std::vector<std::pair<std::string, std::string>>;
using ForeignNetworks = NetworkCase;

const std::string bom = "\xef\xbb\xbf";

/// A graph of an image, as VesselGraph writes it: no units, a vessel from a junction to itself, an island.
const Files vessel_graph{
    {"nodes.csv",
     "id;pos_x;pos_y;pos_z;degree;isAtSampleBorder\n0;0;0;0;1;1\n1;50;0;0;3;0\n2;100;30;0;2;0\n"
     "3;150;0;0;1;1\n4;300;0;0;1;0\n5;340;0;0;1;0\n"},
    {"edges.csv",
     "id;node1id;node2id;length;distance;curveness;avgRadiusAvg;num_voxels\n"
     "0;0;1;51.2;50;1.02;4.1;46\n1;1;2;60.1;58.3;1.03;3.0;15\n2;1;2;71.0;58.3;1.21;2.4;15\n"
     "3;2;3;59.9;58.3;1.03;3.5;8\n4;1;1;6.3;0;0;2.0;6\n5;4;5;40.4;40;1.01;2.2;9\n"}};

TEST_F(ForeignNetworks, VesselGraphNeedsItsUnitAndWhatToDoWithLoopsAndIslands) {
  refused([&] { network(vessel_graph); },
          {"nodes.csv:1", "edges.csv:1", "column x", "column radius", "network.file_length_unit"});
  Parameters p;
  p.file_length_unit = "um";
  refused([&] { network(vessel_graph, p); }, {"edges.csv:6", "vessel 4", "to itself", "network.drop"});
  p.drop = {"self_loops", "islands"};
  p.conditions = {{.junction = "0", .pressure = 5000}, {.nearest = {1.6e-4, 1e-6, 0}, .pressure = 3000}};
  const BoundedGraph n = network(vessel_graph, p);
  ASSERT_EQ(n.graph.vessels(), 4u);
  EXPECT_EQ(n.graph.junctions, 4u);
  EXPECT_DOUBLE_EQ(n.graph.radius[3], 3.5e-6);
  EXPECT_DOUBLE_EQ(n.graph.length[2], 71e-6);
  EXPECT_EQ(n.vessel_line, (std::vector<std::uint32_t>{2, 3, 4, 5}));
  ASSERT_EQ(n.conditions.size(), 2u);
  EXPECT_EQ(n.graph.name_of_junction(n.conditions[1].junction), "3");
  for (const char* part : {"columns that are not read: degree, isAtSampleBorder", "num_voxels",
                           "1 vessels that lead", "the first is 4", "1 vessels of parts without",
                           "the first is 5", "condition[2] is at junction 3, 10 um"})
    EXPECT_NE(notes_of(n).find(part), std::string::npos) << part << "\n" << notes_of(n);
}

struct Expected {
  std::string what;
  Files files;
  double radius = 0, length = 0;       ///< m, of the first vessel; 0: the files are refused
  std::vector<std::string> fragments;  ///< of the notes, or of the message
  std::string length_unit = {};
};

const std::string j = bom + "id,x [mm],y [mm],z [mm],pressure [mmHg]\r\nin,0,0,0,35\r\nout,1.5,0,0,15\r\n";

std::string utf16(const std::string& ascii) {
  std::string bytes = "\xff\xfe";
  for (const char c : ascii) bytes += {c, '\0'};
  return bytes;
}

const std::string arm =
    R"({"vertices": [{"id": 0, "name": "in"}, {"id": 1, "name": "mid"}, {"id": 2, "name": "out", "inflow": true}],
    "vessels": [{"id": 0, "name": "upper", "vessel_length": 1.1, "radius": 0.12, "wall_thickness": 0.03, "gamma": 2,
                 "left_vertex_id": 0, "right_vertex_id": 1},
                {"id": 1, "name": "lower", "vessel_length": 1.3, "radius": 0.1, "left_vertex_id": 1, "right_vertex_id": 2}]})";
const std::string own_arm =
    R"({"units": {"length": "cm", "pressure": "mmHg"}, "junctions": [{"id": 0, "pressure": 90}, {"id": 1.0}, {"id": "2"}],
    "vessels": [{"id": 0, "name": "upper", "length": 1.1, "radius": 0.12, "from": "0", "to": 1},
                {"id": 1, "length": 1.3, "radius": 0.1, "from": 1, "to": 2}]})";

const std::vector<Expected> cases{
    {"upper case, CRLF, byte order mark",
     {{"J.CSV", j}, {"V.CSV", bom + "ID,From,To,Diameter [um],LENGTH (um)\r\n1,in,out,5.56,1500.5\r\n"}},
     2.78e-6,
     1500.5e-6,
     {}},
    {"micro sign",
     {{"j.csv", j}, {"v.csv", "id,from,to,diameter [\xc2\xb5m],length [\xce\xbcm]\n1,in,out,5.56,1500.5\n"}},
     2.78e-6,
     1500.5e-6,
     {}},
    {"UTF-16",
     {{"j.csv", j}, {"v.csv", utf16("id,from,to,diameter [um],length [um]\r\n1,in,out,5.56,1500.5\r\n")}},
     2.78e-6,
     1500.5e-6,
     {}},
    {"decimal comma",
     {{"j.csv", j}, {"v.csv", "id;from;to;diameter [um];length [um]\n1;in;out;5,56;1500,5\n"}},
     2.78e-6,
     1500.5e-6,
     {}},
    {"ids of whole numbers",
     {{"j.csv", "id,pressure [mmHg]\n1,35\n2,15\n"},
      {"v.csv", "id,from,to,diameter [um],length [um]\n7,1.0,2.0,5,1500\n"}},
     2.5e-6,
     1.5e-3,
     {}},
    {"no diameter in a row",
     {{"j.csv", j}, {"v.csv", "id,from,to,diameter [um],length [um]\n1,in,out,,1500\n"}},
     0,
     0,
     {"v.csv:2", "radius of vessel 1 is missing"}},
    {"nan",
     {{"j.csv", j}, {"v.csv", "id,from,to,diameter [um],length [um]\n1,in,out,nan,1500\n"}},
     0,
     0,
     {"v.csv:2", "diameter = nan"}},
    {"nm for um",
     {{"j.csv", j}, {"v.csv", "id,from,to,diameter [um],length [nm]\n1,in,out,5.56,1500\n"}},
     0,
     0,
     {"v.csv:2", "vessel 1", "length 1.5 um", "1.5 mm apart", "unit"}},
    {"m for um",
     {{"j.csv", j}, {"v.csv", "id,from,to,diameter [m],length [um]\n1,in,out,5.56,1500\n"}},
     2.78,
     1.5e-3,
     {"v.csv:2: vessel 1: radius 2.78 m, wider than any vessel, above 30 mm",
      "length 1.5 mm, below the radius, 2.78 m"}},
    {"vessels for junctions",
     {{"v.csv", "id,from,to,radius [um]\n1,in,out,5\n"}, {"j.csv", j}},
     0,
     0,
     {"v.csv:1", "junctions first"}},
    {"tapering vessels",
     {{"j.csv", j}, {"v.csv", "id,from,to,radius_proximal [mm],radius_distal [mm]\n1,in,out,2,1\n"}},
     0,
     0,
     {"v.csv:1", "radius and diameter", "radius_proximal"}},
    {"a radius without unit",
     {{"j.csv", j}, {"v.csv", "id,from,to,radius\n1,in,out,2\n"}},
     0,
     0,
     {"v.csv:1", "radius needs its unit", "network.file_length_unit"}},
    {"a radius in the unit of the input",
     {{"j.csv", j}, {"v.csv", "id,from,to,radius\n1,in,out,2\n"}},
     2e-6,
     1.5e-3,
     {},
     "um"},
    {"a unit of the input that is not needed",
     {{"j.csv", j}, {"v.csv", "id,from,to,radius [um]\n1,in,out,2\n"}},
     2e-6,
     1.5e-3,
     {"network.file_length_unit is not used"},
     "mm"},
    {"a 1-D solver's vessels, without unit",
     {{"arm.json", arm}},
     0,
     0,
     {"vessels[0].radius needs units.length", "network.file_length_unit", "vessels[1]"}},
    {"a 1-D solver's vessels",
     {{"arm.json", arm}},
     1.2e-3,
     1.1e-2,
     {"members of vertices that are not read: inflow", "members of vessels that are not read: gamma"},
     "cm"},
    {"own names and other members", {{"arm.json", own_arm}}, 1.2e-3, 1.1e-2, {}},
    {"a 0-D solver's vessels",
     {{"s.json",
       R"({"simulation_parameters": {}, "boundary_conditions": [], "junctions": [], "vessels": [{"vessel_id": 0, "vessel_length": 10.0, "zero_d_element_type": "BloodVessel"}]})"}},
     0,
     0,
     {"s.json", "0-D solver", "radius"}},
    {"GraphML without radii",
     {{"g.graphml",
       R"(<?xml version="1.0"?><graphml xmlns="http://graphml.graphdrawing.org/xmlns"><graph edgedefault="undirected"><node id="n0"/><node id="n1"/><edge source="n0" target="n1"/></graph></graphml>)"}},
     0,
     0,
     {"g.graphml", "no attribute of edges is called radius"}},
};

TEST_F(ForeignNetworks, AreReadRightOrRefused) {
  for (const Expected& c : cases) {
    SCOPED_TRACE(c.what);
    Parameters p;
    p.file_length_unit = c.length_unit;
    if (c.radius == 0) {
      refused([&] { network(c.files, p); }, c.fragments);
      continue;
    }
    const BoundedGraph n = network(c.files, p);
    EXPECT_NEAR(n.graph.radius[0] / c.radius, 1, 1e-14);
    EXPECT_NEAR(n.graph.length[0] / c.length, 1, 1e-14);
    for (const std::string& fragment : c.fragments)
      EXPECT_NE(notes_of(n).find(fragment), std::string::npos) << fragment << "\n" << notes_of(n);
    if (c.fragments.empty()) {
      EXPECT_EQ(notes_of(n), "");
    }
  }
}

TEST_F(ForeignNetworks, FaultsAreToldAllAtOnce) {
  std::string vessels = "id,from,to,radius [um]\n";
  for (int i = 0; i < 30; ++i) vessels += std::to_string(i) + (i % 2 == 0 ? ",a,b,-1\n" : ",a,nowhere,1\n");
  refused(
      [&] {
        network({{"j.csv", "id,x [mm],y [mm],z [mm]\na,0,0,zero\nb,1,0,0\nb,2,0,0\n"}, {"v.csv", vessels}});
      },
      {"32 faults:\n", "j.csv:2: z = zero", "j.csv:4: id = b", "v.csv:2: radius of vessel 0",
       "v.csv:3: to = nowhere", "v.csv:19", "\n  and 12 more"});
  // What cannot be known for another fault is none of its own.
  refused(
      [&] {
        network({{"j.csv", "id\na,1\n"}, {"v.csv", "id,from,to,radius [um]\n1,a,b,x\n"}});
      },
      {"2 faults:\n", "j.csv:2: 2 fields", "v.csv:2: radius = x"});
}

TEST_F(ForeignNetworks, HaematocritsAndNamesAreKept) {
  const BoundedGraph n =
      network({{"j.csv", "id,name,pressure [mmHg],Hd\n1,heart,35,0.4\n2,,15,\n3,,,0.5\n"},
               {"v.csv", "id,from,to,radius [um],length [mm],name\n1.0,1,2,5,1,\n2.0,2,3,5,1,last\n"}});
  ASSERT_EQ(n.conditions.size(), 2u);
  EXPECT_EQ(n.conditions[0].haematocrit, 0.4);
  EXPECT_EQ(n.conditions[1].haematocrit, std::nullopt);
  EXPECT_NE(notes_of(n).find("1 junctions with a haematocrit, but neither"), std::string::npos)
      << notes_of(n);
  EXPECT_EQ(find_vessel(n.graph, "last"), 1u);
  EXPECT_EQ(find_vessel(n.graph, "2"), 1u);
  EXPECT_EQ(find_vessel(n.graph, "2.0"), 1u);
  EXPECT_EQ(find_junction(n.graph, "heart"), 0u);
  EXPECT_EQ(find_junction(n.graph, ""), std::nullopt);
  EXPECT_EQ(find_junction(n.graph, "4"), std::nullopt);
  refused(
      [&] {
        network(
            {{"j.csv", "id,pressure [mmHg],hematocrit\n1,35,45\n"}, {"v.csv", "id,from,to,radius [um]\n"}});
      },
      {"j.csv:2", "haematocrit of junction 1 is 45", "at most 0.95"});
}

/// A network in Secomb's form: a byte order mark, tabs, asterisks, further words, a segment without blood.
const std::string secomb =
    bom +
    "small net\n100.0 100.0 50.0  box\n10 10 5 points\n30.\n25.\t maximum\n10\n"
    "3  total number of segments\nname type from to diam flow Hd\n"
    "11 5 1 2 8.0 0.0 0.4 *\n12\t4\t2\t3\t7.0*\t-1.5\t0.4\t9 9\n13 10 3 4 5. 0. 0.\n"
    "4  total number of nodes\nname x y z\n1 0. 0. 0.\n2 50. 0. 0.\n3 90. 30. 0. *\n4 1e2 30 0\n"
    "3  boundary nodes\nnode bctyp press/flow Hd PO2\n1 0 40. 0.45 90.\n3 7 -3. 0.35\n4 2 1 0.4\n";

TEST_F(ForeignNetworks, SecombsFilesAreRead) {
  Parameters p;
  p.file_length_unit = "mm";
  const BoundedGraph n = network({{"network.dat", secomb}}, p);
  ASSERT_EQ(n.graph.vessels(), 2u);
  EXPECT_EQ(n.graph.name_of_vessel(1), "12");
  EXPECT_NEAR(n.graph.radius[1], 3.5e-6, 1e-20);
  EXPECT_NEAR(n.graph.length[1], 50e-6, 1e-18);
  EXPECT_EQ(n.vessel_line, (std::vector<std::uint32_t>{9, 10}));
  ASSERT_EQ(n.conditions.size(), 2u);
  EXPECT_NEAR(n.conditions[0].value, 40 * 133.322, 0.1);
  EXPECT_EQ(n.conditions[0].haematocrit, 0.45);
  EXPECT_EQ(n.conditions[1].kind, BoundaryCondition::Kind::flow);
  EXPECT_NEAR(n.conditions[1].value, -3e-12 / 60, 1e-25);
  EXPECT_EQ(n.conditions[1].haematocrit, 0.35);
  for (const char* part : {"1 segments of other types than 4 and 5", "the first is 13",
                           "1 boundary nodes are no segment's end", "network.file_length_unit is not used"})
    EXPECT_NE(notes_of(n).find(part), std::string::npos) << part << "\n" << notes_of(n);
}

TEST_F(ForeignNetworks, SecombsFilesAreRefusedWithTheLine) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = secomb;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<std::pair<std::string, std::vector<std::string>>> mistakes{
      {"three lines\n\n1\n2\n", {"network.dat:4", "ends before the head of six lines"}},
      {changed("3  total", "three"), {"network.dat:7", "number of segments is expected"}},
      {changed("3  total", "-1"), {"network.dat:7", "number of segments is expected"}},
      {changed("3  total", "1e300"), {"ends before the last of 1e+300 segments"}},
      {changed("12\t4\t2\t3", "12\t4\t2\t9"), {"network.dat:10", "to = 9"}},
      {changed("11 5 1 2 8.0", "11 5 1 2 wide"), {"network.dat:9", "diameter = wide"}},
      {changed("11 5 1 2 8.0 0.0 0.4", "11 5 1 2"), {"network.dat:9", "4 words"}},
      {changed("1 0 40.", "1 3 40."), {"network.dat:20", "type = 3 of boundary node 1", "4 to 9"}},
      {changed("1 0 40.", "3 0 40."), {"network.dat:21", "node 3 is given twice"}},
      {changed("1 0 40. 0.45", "9 0 40. 45"), {"network.dat:20", "no node 9"}},
      {changed("1 0 40. 0.45", "1 0 40. 45"), {"network.dat:14", "haematocrit of junction 1 is 45"}},
      {secomb.substr(0, secomb.find("4 2 1")),
       {"network.dat:21", "ends before the last of 3 boundary nodes", "cut short"}},
  };
  for (const auto& [text, fragments] : mistakes)
    refused([&, t = text] { network({{"network.dat", t}}); }, fragments);
}

TEST_F(ForeignNetworks, DirectionsOfFlowAreNoConditions) {
  const std::string known_ends = secomb.substr(0, secomb.rfind("1 0 40."));
  const Files dat{{"network.dat", known_ends + "1 -2 1. 0.45\n3 -2 -1.\n4 2 1 0.4\n"}};
  const std::string vessels = "id,from,to,radius [um],length [um]\n1,a,b,5,100\n";
  const Files csv{{"j.csv", "id,flow [mL/min]\na,Inlet\nb,out\n"}, {"v.csv", vessels}};
  const Files json{
      {"n.json",
       R"({"units": {"length": "um", "flow": "mL/min"}, "junctions": [{"id": "a", "flow": "in"}, {"id": "b", "flow": 0.5}],
           "vessels": [{"id": 1, "from": "a", "to": "b", "radius": 5, "length": 100}]})"}};
  refused([&] { network(dat); }, {"network.dat: only the direction", "at 2 ends: 1, 3.", "[[condition]]"});
  refused([&] { network(csv); }, {"v.csv: only the direction", "at 2 ends: a, b.", "[[condition]]"});
  refused([&] { network(json); }, {"n.json: only the direction", "at 1 end: a."});
  refused(
      [&] {
        network({{"j.csv", "id,flow [mL/min]\na,much\nb,1\n"}, {"v.csv", vessels}});
      },
      {"j.csv:2: flow = much: not a finite number"});
  Parameters p;
  p.conditions = {{.junction = "1", .pressure = 4000}};
  refused([&] { network(dat, p); }, {"at 1 end: 3."});
  p.conditions.push_back({.junction = "3", .flow = -1e-13});
  EXPECT_EQ(network(dat, p).conditions.size(), 2u);
}

const std::string graphml_head =
    R"(<?xml version="1.0"?><!DOCTYPE graphml><!-- by hand --><g:graphml xmlns:g="http://graphml.graphdrawing.org/xmlns">
<key id="x" for="node" attr.name="X" attr.type="double"/><key id="y" for="node" attr.name="y"/><key id="z" for="node" attr.name="z"><default>0</default></key>
<key id="p" for="node" attr.name="pressure [mmHg]"/><key id="r" for="edge" attr.name="radius [um]"/><key id="n" for="all" attr.name="name"/><key id="w" for="edge" attr.name="weight"/>
<graph edgedefault="undirected">)";
const std::string graphml_nodes =
    R"(<node id="a"><data key="x"> 0 </data><data key="y">0</data><data key="p">35</data></node>
<node id='b&amp;c'><data key="x">3</data><data key="y"><![CDATA[4]]></data><data key="n">&#x41;&#66;</data></node>)";

TEST_F(ForeignNetworks, GraphMlIsRead) {
  Parameters p;
  p.file_length_unit = "mm";
  const BoundedGraph n = network(
      {{"n.graphml",
        graphml_head +
            "<edge source=\"a\" target=\"b&amp;c\"><data key='r'>7</data><data key='w'>3</data></edge>" +
            graphml_nodes + "</graph></g:graphml>\n"}},
      p);
  ASSERT_EQ(n.graph.vessels(), 1u);
  EXPECT_DOUBLE_EQ(n.graph.radius[0], 7e-6);
  EXPECT_DOUBLE_EQ(n.graph.length[0], 5e-3);
  EXPECT_EQ(n.graph.name_of_junction(1), "b&c");
  EXPECT_EQ(find_junction(n.graph, "AB"), 1u);
  ASSERT_EQ(n.conditions.size(), 1u);
  EXPECT_NE(notes_of(n).find("attributes that are not read: weight"), std::string::npos) << notes_of(n);
}

TEST_F(ForeignNetworks, GraphMlIsRefusedWithTheLine) {
  const std::string edge = "<edge source=\"a\" target=\"b&amp;c\"><data key='r'>7</data></edge>";
  const std::vector<std::pair<std::string, std::vector<std::string>>> mistakes{
      {"<graphml>", {"n.graphml:1", "<graphml> does not end"}},
      {"<graphml></graphml>", {"no <graph>"}},
      {"<a><b></a></b>", {"</a> ends <b>"}},
      {"<a b=c/>", {"not quoted"}},
      {"<a>&nbsp;</a>", {"entity 'nbsp'"}},
      {"<!DOCTYPE a [<!ENTITY b \"c\">]><a/>", {"entities"}},
      {"text", {"text outside"}},
      {"<a/><b/>", {"second root"}},
      {graphml_head + graphml_nodes + edge, {"<graph> does not end"}},
      {graphml_head + graphml_nodes +
           "<edge source=\"a\" target=\"d\"><data key='r'>7</data></edge></graph></g:graphml>",
       {"n.graphml:5", "to = d"}},
      {graphml_head + graphml_nodes +
           "\n<edge source=\"a\" target=\"a\"><data key='r'>wide</data></edge></graph></g:graphml>",
       {"n.graphml:6", "radius = wide"}},
      {graphml_head + graphml_nodes + "<hyperedge/></graph></g:graphml>", {"hyperedge"}},
      {graphml_head + graphml_nodes + edge + "<graph/></graph></g:graphml>", {"second graph"}},
  };
  Parameters p;
  p.file_length_unit = "mm";
  for (const auto& [text, fragments] : mistakes)
    refused([&, t = text] { network({{"n.graphml", t}}, p); }, fragments);
  refused(
      [&] {
        network({{"n.graphml", graphml_head + graphml_nodes + edge + "</graph></g:graphml>"}});
      },
      {"attribute X needs its unit", "network.file_length_unit"});
}

}  // namespace
}  // namespace rhexis::network
