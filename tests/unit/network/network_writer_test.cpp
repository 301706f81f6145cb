// SPDX-License-Identifier: BSD-3-Clause
// What is written of a network can be read again, with the same numbers to the last digit.
#include "network/files/network_writer.hpp"

#include "network_case.hpp"

namespace rhexis::network {
namespace {

class NetworkWriter : public NetworkCase {};

const char* const junctions =
    "id,name,x [um],y [um],z [um],pressure [mmHg],flow [mL/min],resistance [Pa s/m3],haematocrit\n"
    "in,heart,0.1,0,0,,3,,0.41\nm,,1,2,0.3,,,,\nout,,4,6,0.7,11,,1e9,\n";
const char* const vessels =
    "id,from,to,radius [um],length [um],wall_thickness [um],kind,generation\n"
    "a,in,m,0.7,3.3,0.1,artery,2\nb,m,out,0.9,7.1,,,\nc,m,out,0.3,7.7,0.2,vein,\n";

TEST_F(NetworkWriter, JsonHoldsAllOfANetwork) {
  const BoundedGraph first = network({{"j.csv", junctions}, {"v.csv", vessels}});
  const BoundedGraph again = network({{"clean.json", json_of(first)}});
  const Graph &a = first.graph, &b = again.graph;
  EXPECT_EQ(a.junction_name, b.junction_name);
  EXPECT_EQ(a.junction_label, b.junction_label);
  EXPECT_EQ(a.vessel_name, b.vessel_name);
  EXPECT_EQ(a.from, b.from);
  EXPECT_EQ(a.to, b.to);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.wall_thickness, b.wall_thickness);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.generation, b.generation);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.z, b.z);
  ASSERT_EQ(again.conditions.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.conditions[i].junction, first.conditions[i].junction);
    EXPECT_EQ(again.conditions[i].kind, first.conditions[i].kind);
    EXPECT_EQ(again.conditions[i].value, first.conditions[i].value);
    EXPECT_EQ(again.conditions[i].resistance, first.conditions[i].resistance);
    EXPECT_EQ(again.conditions[i].haematocrit, first.conditions[i].haematocrit);
  }
}

TEST_F(NetworkWriter, WhatAVtpFileCannotHoldIsRefused) {
  BoundedGraph held = network({{"j.csv", junctions}, {"v.csv", vessels}});
  refused([&] { check_fits_vtp(held, "clean.vtp"); }, {"clean.vtp", "wall thicknesses of some", ".json"});
  held.graph.wall_thickness = {0, 0, 0};
  refused([&] { check_fits_vtp(held, "clean.vtp"); }, {"clean.vtp", "holds no resistances", ".json"});
  held.conditions[1].resistance = 0;
  EXPECT_NO_THROW(check_fits_vtp(held, "clean.vtp"));
  held.graph.x.clear();
  refused([&] { check_fits_vtp(held, "clean.vtp"); }, {"without coordinates"});
}

}  // namespace
}  // namespace rhexis::network
