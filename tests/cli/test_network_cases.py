# SPDX-License-Identifier: BSD-3-Clause
"""Networks as people have them, from file to flow: the flow of an independent solver, or a refusal that says why.

Run by ctest as: test_network_cases.py RHEXIS SOURCE_DIR MPIRUN...
"""

import csv
import math
import random
import sys
import unittest

from independent_flow import CM, EXACT, MM, MMHG, NL_PER_MIN, UM, solve
from network_case import HAS_PARAVIEW, NetworkCase


def pressures(**of_junctions):
    """[[condition]] sections: the pressure in mmHg at junctions by number, as in _3=40."""
    return "".join(f'[[condition]]\njunction = "{name[1:]}"\npressure = "{p} mmHg"\n' for name, p in of_junctions.items())


def loops():
    """A random network with some 50 loops: its two tables, vessels and conditions."""
    dice = random.Random(4)
    place = [[dice.uniform(0, size) for size in (500, 500, 100)] for _ in range(60)]
    near = [sorted(range(60), key=lambda j: math.dist(place[i], place[j]))[1:4] for i in range(60)]
    edges = sorted({tuple(sorted(edge)) for i in range(60) for edge in [*((i, j) for j in near[i]), (i, (i + 1) % 60)]})
    vessels = [(f"n{a}", f"n{b}", dice.uniform(2, 6) * UM, math.dist(place[a], place[b]) * UM) for a, b in edges]
    known = {0: ",50", 5: ",-7", 59: "20,"}
    junctions = "id,x [um],y [um],z [um],pressure [mmHg],flow [nl/min]\n"
    junctions += "".join(f"n{i},{x!r},{y!r},{z!r},{known.get(i, ',')}\n" for i, (x, y, z) in enumerate(place))
    table = "id,from,to,radius [um]\n" + "".join(f"{k},{a},{b},{r / UM!r}\n" for k, (a, b, r, _) in enumerate(vessels))
    return {"j.csv": junctions, "v.csv": table}, vessels, {"n59": 20 * MMHG}, {"n0": 50 * NL_PER_MIN, "n5": -7 * NL_PER_MIN}


# A graph of an image, as VesselGraph writes it: no units, a vessel from a junction to itself, an island.
VESSEL_GRAPH = {
    "n.csv": "id;pos_x;pos_y;pos_z;degree;isAtSampleBorder\n0;0;0;0;1;1\n1;50;0;0;3;0\n2;100;30;0;2;0\n3;150;0;0;1;1\n4;300;0;0;1;0\n5;340;0;0;1;0\n",
    "e.csv": "id;node1id;node2id;length;distance;curveness;avgRadiusAvg;num_voxels\n0;0;1;51.2;50;1.02;4.1;46\n1;1;2;60.1;58.3;1.03;3.0;15\n"
             "2;1;2;71.0;58.3;1.21;2.4;15\n3;2;3;59.9;58.3;1.03;3.5;8\n4;1;1;6.3;0;0;2.0;6\n5;4;5;40.4;40;1.01;2.2;9\n",
}  # fmt: skip
GRAPH_FLOW = solve([("0", "1", 4.1 * UM, 51.2 * UM), ("1", "2", 3 * UM, 60.1 * UM), ("1", "2", 2.4 * UM, 71 * UM), ("2", "3", 3.5 * UM, 59.9 * UM)],
                   {"0": 40 * MMHG, "3": 20 * MMHG})[0]  # fmt: skip
SECOMB = """small net
100.0 100.0 50.0  box
10 10 5
30.
25.
10
2  total number of segments
name type from to diam flow Hd
1 5 1 2 8.0 0.0 0.4 *
2\t4\t2\t3\t7.0\t0.0\t0.4
3  nodes
name x y z
1 0. 0. 0.
2 50. 0. 0.
3 90. 30. 0. *
2  boundary nodes
node bctyp press/flow Hd PO2
1 {ends[0]} 0.45 90.
3 {ends[1]} 0.45 40.
"""
SWC = "# a skeleton: id type x y z radius parent\n1 1 0 0 0 4.0 -1\n2 3 50 0 0 4.0 1\n3 3 90 30 0 4.0 2\n"
LEGACY = ("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 0 0\nLINES 1 3\n2 0 1\n"
          "CELL_DATA 1\nSCALARS radius float 1\nLOOKUP_TABLE default\n0.125\n")  # fmt: skip
GRAPHML = ('<?xml version="1.0"?><graphml xmlns="http://graphml.graphdrawing.org/xmlns"><key id="r" for="edge" attr.name="{}"/>'
           '<key id="l" for="edge" attr.name="length"/><graph edgedefault="undirected"><node id="n0"/><node id="n1"/>'
           '<edge source="n0" target="n1"><data key="r">4</data><data key="l">50</data></edge></graph></graphml>')  # fmt: skip
ARM = """{"vertices": [{"id": 0, "name": "in"}, {"id": 1}, {"id": 2, "name": "out"}], "vessels": [
 {"id": 0, "vessel_length": 1.1, "radius": 0.12, "wall_thickness": 0.03, "gamma": 2, "left_vertex_id": 0, "right_vertex_id": 1},
 {"id": 1, "vessel_length": 1.3, "radius": 0.10, "wall_thickness": 0.02, "gamma": 2, "left_vertex_id": 1, "right_vertex_id": 2}]}"""
ARM_FLOW = solve([("0", "1", 0.12 * CM, 1.1 * CM), ("1", "2", 0.1 * CM, 1.3 * CM)], {"0": 90 * MMHG, "2": 80 * MMHG})[0]
FORK = {"j.csv": "id,x [mm],y [mm],z [mm],pressure [mmHg]\nin,0,0,0,100\nm,10,0,0,\no1,20,5,0,90\no2,20,-5,0,\n",
        "v.csv": "id,from,to,radius [mm]\nt,in,m,2\nb1,m,o1,1.5\nb2,m,o2,1.5\n"}  # fmt: skip
BRANCH = math.hypot(10, 5) * MM
ISLANDS = {"j.csv": "id,pressure [mmHg]\na,100\nb,90\nc,\nd,\n", "v.csv": "id,from,to,radius [mm],length [mm]\n1,a,b,1,10\n2,c,d,1,10\n"}
FLOWS = {"j.csv": "id,x [mm],y [mm],z [mm],flow [cm3/s]\na,0,0,0,1\nb,1,0,0,-1\n", "v.csv": "id,from,to,radius [mm]\n1,a,b,1\n"}
ONE = "id,x [mm],y [mm],z [mm],pressure [mmHg]\nin,0,0,0,35\nout,1.5,0,0,15\n"
LOOPS, LOOP_VESSELS, LOOP_PRESSURES, LOOP_INFLOWS = loops()


def one(diameter, length):
    """Flow of one vessel (um) from 35 to 15 mmHg."""
    return solve([("in", "out", 0.5e-6 * diameter, 1e-6 * length)], {"in": 35 * MMHG, "out": 15 * MMHG})[0]


def table(text, junctions=ONE):
    return {"j.csv": junctions, "v.csv": text}


# name, files, keys of [network] (and further sections), flow through the first vessel, what is told
SOLVED = [
    ("graph of an image", VESSEL_GRAPH, 'file_length_unit = "um"\ndrop = ["self_loops", "islands"]\n' + pressures(_0=40, _3=20), GRAPH_FLOW,
     ["1 vessels that lead from a junction to itself", "1 vessels of parts without", "degree, isAtSampleBorder"]),
    (".dat", {"n.dat": SECOMB.format(ends=("0 40.", "0 20."))}, "", solve([("1", "2", 4 * UM, 50 * UM), ("2", "3", 3.5 * UM, 50 * UM)],
     {"1": 40 * MMHG, "3": 20 * MMHG})[0], ["blood.phase_separation"]),
    (".dat with a flow of a class", {"n.dat": SECOMB.format(ends=("0 40.", "7 -3."))}, "", 3 * NL_PER_MIN, []),
    (".dat with directions, which the input settles", {"n.dat": SECOMB.format(ends=("0 40.", "-2 -1."))}, '[[condition]]\njunction = "3"\nflow = "-3 nl/min"\n',
     3 * NL_PER_MIN, []),
    ("SWC", {"n.swc": SWC}, 'file_length_unit = "um"\n' + pressures(_1=40, _3=20), solve([("1", "3", 4 * UM, 100 * UM)], {"1": 40 * MMHG, "3": 20 * MMHG})[0], []),
    ("GraphML", {"n.graphml": GRAPHML.format("radius")}, 'file_length_unit = "um"\n' + pressures(_n0=40, _n1=20),
     solve([("n0", "n1", 4 * UM, 50 * UM)], {"n0": 40 * MMHG, "n1": 20 * MMHG})[0], []),
    ("legacy .vtk", {"n.vtk": LEGACY}, 'file_length_unit = "mm"\n' + pressures(_0=40, _1=20), solve([("0", "1", 0.125 * MM, MM)], {"0": 40 * MMHG, "1": 20 * MMHG})[0], []),
    ("1-D solver", {"arm.json": ARM}, 'file_length_unit = "cm"\n' + pressures(_0=90, _2=80), ARM_FLOW, ["members of vessels that are not read: gamma"]),
    ("forgotten outlet", FORK, "", solve([("in", "m", 2 * MM, 10 * MM), ("m", "o1", 1.5 * MM, BRANCH)], {"in": 100 * MMHG, "o1": 90 * MMHG})[0],
     ["an end of the network has no condition, so that nothing flows there: o2", "in 1 of 3 vessels"]),
    ("islands that are left out", ISLANDS, 'drop = ["islands"]\n', solve([("a", "b", MM, 10 * MM)], {"a": 100 * MMHG, "b": 90 * MMHG})[0], ["1 vessels of parts"]),
    ("flows alone", FLOWS, 'reference_pressure = "20 mmHg"\n', 1e-6, ["junction b has network.reference_pressure"]),
    ("loops", LOOPS, "", solve(LOOP_VESSELS, LOOP_PRESSURES, LOOP_INFLOWS)[0], ["60 junctions"]),
    ("upper case, micro sign, byte order mark", {"J.CSV": "\ufeff" + ONE, "V.CSV": "\ufeffID,From,To,Diameter [\u00b5m],Length (\u03bcm)\n1,in,out,5.56,1500.5\n"}, "", one(5.56, 1500.5), []),
    ("decimal comma", table("id;from;to;diameter [um];length [um]\n1;in;out;5,56;1500,5\n"), "", one(5.56, 1500.5), []),
    ("ids that are whole numbers", table("id,from,to,diameter [um],length [um]\n7,1.0,2.0,5,1500\n", "id,pressure [mmHg]\n1,35\n2,15\n"), "", one(5, 1500), []),
    ("metres for micrometres", table("id,from,to,diameter [m],length [um]\n1,in,out,5.56,1500.5\n"), "", one(5.56e6, 1500.5),
     ["v.csv:2: vessel 1: radius 2.78 m, wider than any vessel", "v.csv:2: vessel 1: length 1.5 mm, below the radius", "are those of no circulation"]),
    ("assumed walls", table("id,from,to,radius [mm],length [mm]\n1,in,out,12,300\n"), "[screening]\ntop = 1\n", one(24e3, 300e3),
     ["the risks of 1 of 1 vessels rest on assumed walls", "wall 4 mm (assumed)"]),
]  # fmt: skip

# name, files, keys of [network] (and further sections), what the message says
REFUSED = [
    ("graph of an image, as it is", VESSEL_GRAPH, "", ["5 faults", "n.csv:1: column x needs its unit", "e.csv:1: column radius needs its unit", "network.file_length_unit"]),
    ("graph of an image with its loop", VESSEL_GRAPH, 'file_length_unit = "um"\n', ["e.csv:6: vessel 4 leads from junction 1 to itself", "network.drop"]),
    ("graph of an image with its island", VESSEL_GRAPH, 'file_length_unit = "um"\ndrop = ["self_loops"]\n' + pressures(_0=40, _3=20), ["junction 4", "network.drop"]),
    ("directions of flow", {"n.dat": SECOMB.format(ends=("-2 1.", "0 20."))}, "", ["n.dat: only the direction of the flow is told at 1 end: 1.", "[[condition]]"]),
    ("SWC without unit", {"n.swc": SWC}, "", ["network.file_length_unit", "n.swc cannot tell"]),
    ("SWC without conditions", {"n.swc": SWC}, 'file_length_unit = "um"\n', ["junction 1", "condition of pressure"]),
    ("legacy .vtk without unit", {"n.vtk": LEGACY}, "", ["network.file_length_unit", "n.vtk cannot tell"]),
    ("GraphML without radius", {"n.graphml": GRAPHML.format("weight")}, 'file_length_unit = "um"\n', ["no attribute of edges is called radius or diameter"]),
    ("1-D solver without unit", {"arm.json": ARM}, "", ["vessels[0].radius needs units.length", "vessels[1].radius"]),
    ("0-D solver", {"s.json": '{"simulation_parameters": {}, "vessels": [{"vessel_id": 0, "zero_d_element_type": "BloodVessel"}]}'}, "", ["input of a 0-D solver"]),
    ("islands", ISLANDS, "", ["nothing sets the pressure", "junction c"]),
    ("flows alone", FLOWS, "", ["nothing sets the pressure", "junction a", "network.reference_pressure"]),
    ("missing value", table("id,from,to,diameter [um],length [um]\n1,in,out,,1500\n"), "", ["v.csv:2: radius of vessel 1 is missing"]),
    ("nanometres for micrometres", table("id,from,to,diameter [um],length [nm]\n1,in,out,5.56,1500\n"), "", ["v.csv:2: vessel 1: length 1.5 um, but its ends are 1.5 mm apart"]),
    ("nan", table("id,from,to,diameter [um],length [um]\n1,in,out,nan,1500\n"), "", ["v.csv:2: diameter = nan"]),
    ("tables in the wrong order", {"v.csv": "id,from,to,radius [um]\n1,in,out,5\n", "j.csv": ONE}, "", ["v.csv:1: a table of vessels; network.files names that of the junctions first"]),
    ("tapering vessels", table("id,from,to,radius_proximal [mm],radius_distal [mm]\n1,in,out,2,1\n"), "", ["v.csv:1: give one of the columns radius and diameter", "radius_proximal"]),
    ("no unit", table("id,from,to,radius\n1,in,out,2\n"), "", ["v.csv:1: column radius needs its unit"]),
]  # fmt: skip


class NetworkCases(NetworkCase):
    def scene(self, files, keys):
        for name, text in files.items():
            self.write(name, text)
        names = ", ".join(f'"{name}"' for name in files)
        self.write("n.toml", '[scene]\nmodel = "network"\n[blood]\nviscosity_law = "constant"\n[network]\nsource = "file"\n'
                   f"files = [{names}]\n{keys}")  # fmt: skip
        return ["n.toml", *files]

    def test_flows_are_those_of_an_independent_solver(self):
        for name, files, keys, flow, told in SOLVED:
            if name.startswith("legacy") and not HAS_PARAVIEW:
                continue
            with self.subTest(name):
                self.scene(files, keys)
                result = self.run_well("n.toml", "-o", "out", "--set", "insitu.enabled=false")
                with open(self.path / "out/vessels.csv", encoding="utf-8") as file:
                    found = float(next(csv.DictReader(file))["flow_m3_s"])
                self.assertLess(abs(found / flow - 1), EXACT)
                for fragment in told:
                    self.assertIn(fragment, result.stdout + result.stderr)

    def test_what_cannot_be_read_is_refused_with_the_reason(self):
        for name, files, keys, fragments in REFUSED:
            with self.subTest(name):
                for file in self.path.iterdir():
                    file.unlink()
                names = self.scene(files, keys)
                self.assert_refused(self.rhexis("run", "n.toml"), fragments, name, names)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
