// SPDX-License-Identifier: BSD-3-Clause
// Networks as VTP: what ParaView and centre line tools write is read, what we write comes back.
#include "network/files/vtp_network.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/error.hpp"
#include "core/plugin.hpp"
#include "support/trees.hpp"
#include "unit/output/temporary_directory.hpp"

namespace rhexis::network {
namespace {

class VtpNetwork : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_plugin("librhexis_vtp.so")) GTEST_SKIP() << "built without ParaView";
  }
  std::filesystem::path write(const std::string& text) {
    std::ofstream(folder_ / "n.vtp", std::ios::binary) << text;
    return folder_ / "n.vtp";
  }
  void refused(const std::string& text, const std::vector<std::string>& fragments) {
    try {
      read_vtp_network(write(text), 1);
      ADD_FAILURE() << "accepted; expected: " << fragments.front();
    } catch (const InputError& error) {
      for (const std::string& fragment : fragments) {
        EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos)
            << error.what() << "\nlacks " << fragment;
      }
    }
  }
  test::TemporaryDirectory folder_;
};

std::string array(const std::string& name, const std::string& values) {
  return "<DataArray type=\"Float64\" Name=\"" + name + "\" format=\"ascii\">" + values + "</DataArray>";
}

/// Ascii PolyData of lines: coordinates, connectivity, offsets, point and cell arrays.
std::string polydata(int points, int lines, const std::string& coordinates, const std::string& connectivity,
                     const std::string& offsets, const std::string& point_data,
                     const std::string& cell_data) {
  return "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData><Piece "
         "NumberOfPoints=\"" +
         std::to_string(points) + "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(lines) +
         "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\"><PointData>" + point_data + "</PointData><CellData>" +
         cell_data +
         "</CellData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" +
         coordinates +
         "</DataArray></Points><Lines><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" +
         connectivity + "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">" + offsets +
         "</DataArray></Lines></Piece></PolyData></VTKFile>\n";
}

TEST_F(VtpNetwork, RoundTripOfATree) {
  const Graph graph = TreePair(test::random_rules(6)).materialise();
  std::vector<double> condition(graph.junctions, NAN);
  condition[0] = 12600;
  condition[64] = 600;
  const NamedArray points[] = {{"pressure_condition", condition}};
  write_vtp_network(folder_ / "t.vtp", graph, points, {});
  const BoundedGraph read = read_vtp_network(folder_ / "t.vtp", 1);
  const Graph& again = read.graph;
  ASSERT_EQ(read.conditions.size(), 2u);
  EXPECT_EQ(read.conditions[0].value, 12600);
  EXPECT_EQ(read.conditions[0].junction, again.from[0]);
  ASSERT_EQ(again.vessels(), graph.vessels());
  EXPECT_EQ(again.junctions, graph.junctions);
  EXPECT_EQ(again.radius, graph.radius);
  EXPECT_EQ(again.length, graph.length);
  EXPECT_EQ(again.kind, graph.kind);
  EXPECT_EQ(again.generation, graph.generation);
  for (std::size_t v = 0; v < graph.vessels(); ++v) {
    EXPECT_EQ(again.x[again.from[v]], graph.x[graph.from[v]]);
    EXPECT_EQ(again.y[again.to[v]], graph.y[graph.to[v]]);
  }
}

TEST_F(VtpNetwork, HaematocritsOfTheBloodThatEnters) {
  Graph graph;
  graph.junctions = 3;
  graph.x = {0, 1e-3, 2e-3};
  graph.y = graph.z = {0, 0, 0};
  graph.from = {0, 1};
  graph.to = {1, 2};
  graph.radius = {1e-5, 2e-5};
  graph.length = {1e-3, 1e-3};
  const auto read = [&](std::vector<double> haematocrit) {
    const std::vector<double> pressure{4000, NAN, NAN}, flow{NAN, NAN, -1e-12};
    const NamedArray points[] = {
        {"pressure_condition", pressure}, {"flow_condition", flow}, {"haematocrit_condition", haematocrit}};
    write_vtp_network(folder_ / "t.vtp", graph, points, {});
    return read_vtp_network(folder_ / "t.vtp", 1);
  };
  const BoundedGraph n = read({0.3, 0.4, NAN});
  ASSERT_EQ(n.conditions.size(), 2u);
  EXPECT_EQ(n.conditions[0].haematocrit, 0.3);
  EXPECT_EQ(n.conditions[1].haematocrit, std::nullopt);
  ASSERT_EQ(n.notes.size(), 1u);
  EXPECT_NE(n.notes[0].find("1 points with a haematocrit, but neither"), std::string::npos) << n.notes[0];
  for (const double wrong : {45.0, -0.1, HUGE_VAL}) {
    try {
      read({wrong, NAN, NAN});
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("point 0: haematocrit_condition is"), std::string::npos)
          << error.what();
    }
  }
}

TEST_F(VtpNetwork, LinesFromAPointToItselfAreLeftOutWhereThatIsAsked) {
  // A triangle that begins and ends at point 0, a line that never leaves it, and one to point 3.
  const auto file = write(polydata(4, 3, "0 0 0  3 0 0  0 4 0  9 0 0", "0 1 2 0  0 0  0 3", "4 6 8", "",
                                   array("radius", "1 1 2")));
  EXPECT_THROW(read_vtp_network(file, 1e-3), InputError);
  const BoundedGraph n = read_vtp_network(file, 1e-3, default_merge_tolerance, true);
  ASSERT_EQ(n.graph.vessels(), 1u);
  EXPECT_EQ(n.graph.junctions, 2u);
  EXPECT_DOUBLE_EQ(n.graph.radius[0], 2e-3);
  EXPECT_EQ(n.graph.name_of_vessel(0), "2");
  ASSERT_EQ(n.notes.size(), 1u);
  EXPECT_NE(n.notes[0].find("2 lines that lead from a point to itself"), std::string::npos) << n.notes[0];
}

TEST_F(VtpNetwork, PolylinesBecomeVesselsBetweenBranchings) {
  // A line of three pieces (3, 4 and 12 long), and one that leaves its second point, which therefore cuts it.
  const BoundedGraph n = read_vtp_network(write(polydata(5, 2, "0 0 0  3 0 0  3 4 0  3 4 12  9 0 0",
                                                         "0 1 2 3  1 4", "4 6", "", array("radius", "1 2"))),
                                          1e-3);
  const Graph& g = n.graph;
  ASSERT_EQ(g.vessels(), 3u);
  EXPECT_EQ(g.junctions, 4u);
  EXPECT_DOUBLE_EQ(g.length[0], 3e-3);
  EXPECT_DOUBLE_EQ(g.length[1], 16e-3);
  EXPECT_DOUBLE_EQ(g.radius[1], 1e-3);
  EXPECT_DOUBLE_EQ(g.radius[2], 2e-3);
}

TEST_F(VtpNetwork, TaperedPieceHasTheResistanceOfItsTaper) {
  const BoundedGraph n = read_vtp_network(
      write(polydata(2, 1, "0 0 0  5 0 0", "0 1", "2", array("MaximumInscribedSphereRadius", "2 1"), "")), 1);
  // 1/r^4 by its mean along the taper, by the midpoint rule.
  double mean = 0;
  constexpr int pieces = 100000;
  for (int i = 0; i < pieces; ++i) mean += std::pow(2 - (i + 0.5) / pieces, -4) / pieces;
  EXPECT_NEAR(n.graph.radius[0], std::pow(mean, -0.25), 1e-9);
}

TEST_F(VtpNetwork, CoincidentPointsAreOneJunction) {
  const BoundedGraph n = read_vtp_network(
      write(polydata(4, 2, "0 0 0  1 0 0  1 0 0  2 0 0", "0 1 2 3", "2 4", "", array("Diameter", "1 1"))), 1);
  EXPECT_EQ(n.graph.junctions, 3u);
  EXPECT_EQ(n.graph.to[0], n.graph.from[1]);
  EXPECT_DOUBLE_EQ(n.graph.radius[0], 0.5);
}

TEST_F(VtpNetwork, Mistakes) {
  const std::string two = "0 0 0  1 0 0";
  refused("nonsense", {"n.vtp"});
  refused("", {"n.vtp"});
  const std::string good = polydata(2, 1, two, "0 1", "2", "", array("radius", "1"));
  refused(good.substr(0, good.size() / 2), {"n.vtp"});
  refused(polydata(2, 1, two, "0 1", "2", "", array("thickness", "1")), {"radius", "thickness"});
  refused(polydata(2, 1, two, "0 1", "2", "", array("radius", "-1")), {"cell 0", "radius", "-1"});
  refused(polydata(2, 1, two, "0 1", "2", "", array("radius", "1e8")),
          {"cell 0", "radius", "above 100 m", "network.file_length_unit"});
  refused(polydata(2, 1, two, "0 1", "2", "", array("radius", "1e-13")),
          {"cell 0", "radius", "below 1e-12 m", "network.file_length_unit"});
  refused(polydata(2, 1, two, "0 1", "2", "", array("radius", "1") + array("generation", "-2")),
          {"cell 0", "generation is -2", "-1 .. 127"});
  refused(polydata(2, 1, two, "0 0", "2", "", array("radius", "1")), {"cell 0"});
  refused(polydata(2, 1, two, "0 7", "2", "", array("radius", "1")), {"n.vtp"});
  refused(polydata(2, 0, two, "", "", "", ""), {"line"});
  EXPECT_THROW(read_vtp_network(folder_ / "absent.vtp", 1), InputError);
}

TEST_F(VtpNetwork, RefusesWhatCrashesVtk) {
  const std::string good = polydata(2, 1, "0 0 0 1 0 0", "0 1", "2", "", array("radius", "1"));
  EXPECT_EQ(read_vtp_network(write(good), 1).graph.vessels(), 1u);
  struct Case {
    std::string from, to;  // what is put in place of a part of the good file
    std::vector<std::string> fragments;
  };
  const std::string integers =
      "<DataArray type=\"Int32\" Name=\"radius\" format=\"ascii\">1</DataArray></CellData>";
  const Case cases[] = {
      {"NumberOfPoints=\"2\"", "NumberOfPoints=\"-1\"", {"NumberOfPoints = -1 is no number"}},
      {"NumberOfPoints=\"2\"", "NumberOfPoints=\"-2147483648\"", {"NumberOfPoints = -2147483648"}},
      {"NumberOfPoints=\"2\"", "NumberOfPoints=\"two\"", {"NumberOfPoints = two is no number"}},
      {"NumberOfPoints=\"2\"", "NumberOfPoints=\"300\"", {"n.vtp"}},
      {"NumberOfVerts=\"0\"", "NumberOfVerts=\"4294967296\"", {"4294967296", "bytes cannot hold"}},
      {"NumberOfVerts=\"0\"", "NumberOfVerts=\"99999999999999\"", {"bytes cannot hold"}},
      {"NumberOfLines=\"1\"", "NumberOfLines=\"\"", {"no lines (but 2 points)"}},
      {"Name=\"radius\"",
       "Name=\"radius\" NumberOfComponents=\"4294967296\"",
       {"array radius", "4294967296"}},
      {"Name=\"radius\"", "Name=\"radius\" NumberOfComponents=\"-1\"", {"array radius", "-1 components"}},
      {"</CellData>", array("radius", "1") + "</CellData>", {"two arrays", "the name radius"}},
      {"</CellData>", integers, {"two arrays", "the name radius"}},
      {"Name=\"connectivity\" format=\"ascii\"", "Name=\"connectivity\" format=\"binary\"", {"VTP"}},
      {"byte_order", "header_type=\"UInt6\" byte_order", {"header_type"}},
  };
  for (const Case& c : cases) {
    std::string text = good;
    const auto place = text.find(c.from);
    ASSERT_NE(place, std::string::npos) << c.from;
    SCOPED_TRACE(c.to);
    refused(text.replace(place, c.from.size(), c.to), c.fragments);
  }
}

/// Four bytes of a number, as VTK writes them before each block of data; then the numbers.
std::string block(const std::vector<double>& values) {
  const auto size = static_cast<std::uint32_t>(values.size() * sizeof(double));
  return std::string(reinterpret_cast<const char*>(&size), 4) +
         std::string(reinterpret_cast<const char*>(values.data()), size);
}

TEST_F(VtpNetwork, AppendedDataAreRead) {
  // Bytes that no XML has stand behind the tags: VTK has to know where the data begin.
  const std::string points = block({0, 0, 0, 3e-3, 0, 0}), radius = block({1e-3});
  std::string text = polydata(2, 1, "", "0 1", "2", "", array("radius", ""));
  const auto append = [&](const std::string& tag, std::size_t offset) {
    const auto place = text.find("format=\"ascii\"></DataArray>", text.find(tag));
    text.replace(place, 27, "format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>");
  };
  append("Name=\"radius\"", 0);
  append("<Points>", radius.size());
  text.insert(text.find("</VTKFile>"),
              "<AppendedData encoding=\"raw\">_" + radius + points + "</AppendedData>");
  const Graph g = read_vtp_network(write(text), 1).graph;
  ASSERT_EQ(g.vessels(), 1u);
  EXPECT_EQ(g.length[0], 3e-3);
  EXPECT_EQ(g.radius[0], 1e-3);
}

/// A fork in the legacy format: the radii of points, and conditions in a field.
TEST_F(VtpNetwork, LegacyFilesAreRead) {
  const std::string text =
      "# vtk DataFile Version 3.0\na fork\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
      "0 0 0 3 0 0 3 4 0 3 -4 0\nLINES 2 7\n3 0 1 2\n2 1 3\nPOINT_DATA 4\n"
      "SCALARS radius double 1\nLOOKUP_TABLE default\n1 1 1 0.5\n"
      "FIELD FieldData 1\nlength 1 4 double\n0 0 0 0\n";
  const Graph g = read_vtp_network(write(text), 1e-3).graph;
  ASSERT_EQ(g.vessels(), 3u);
  EXPECT_DOUBLE_EQ(g.length[0], 3e-3);
  EXPECT_DOUBLE_EQ(g.length[1], 4e-3);
  EXPECT_DOUBLE_EQ(g.radius[1], 1e-3);
  EXPECT_NEAR(g.radius[2], 1e-3 * tapered_radius(1, 0.5), 1e-18);
  refused(text.substr(0, text.find("SCALARS") + 12), {"legacy VTK"});
  refused(text.substr(0, text.find("LINES")), {"no lines"});
  refused("# vtk DataFile Version 3.0\n", {"legacy VTK"});
}

}  // namespace
}  // namespace rhexis::network
