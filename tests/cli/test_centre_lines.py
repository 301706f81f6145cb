# SPDX-License-Identifier: BSD-3-Clause
"""Centre lines as tools write them: trunks that are repeated for every outlet, gaps at branch points, hostile VTP files.

Run by ctest as: test_centre_lines.py RHEXIS SOURCE_DIR MPIRUN...
"""

import base64
import csv
import math
import os
import re
import struct
import sys
import unittest
import zlib

import numpy
from independent_flow import EXACT, MM, cone_radius, solve
from network_case import HAS_PARAVIEW, SOURCE, NetworkCase

sys.path.insert(0, os.path.join(SOURCE, "postprocessing"))
from centre_lines import INLET_PRESSURE, OUTLET_PRESSURE, STYLES, arch_network, lines_of, write_centre_lines, write_vtp, y_network  # noqa: E402

L_PER_MIN = 1e-3 / 60  # m3/s
SCENE = """\
[scene]
model = "network"
[blood]
viscosity_law = "constant"
[network]
source = "file"
files = ["n.vtp"]
file_length_unit = "mm"
"""
# How far each style may be off: points that are moved by 1 um, or that lie elsewhere on curved vessels, are other vessels.
OFF = {"once": EXACT, "repeated": EXACT, "jitter": 1e-4, "resampled": 1e-3}


def inflow_of(lines, inlet, outlet):
    """The flow (m3/s) from the first point of all to the ends of lines that no other line meets, at these pressures (Pa)."""
    vessels = [(tuple(a[:3].round(6)), tuple(b[:3].round(6)), MM * cone_radius(a[3], b[3]), MM * math.dist(a[:3], b[:3]))
               for line in lines for a, b in zip(line, line[1:])]  # fmt: skip
    begins = {vessel[0] for vessel in vessels}
    pressures = {vessel[1]: outlet for vessel in vessels if vessel[1] not in begins}
    pressures[vessels[0][0]] = inlet
    return solve(vessels, pressures)[0]


def spokes(outlets, gap=0.0, repeated=True):
    """Rows x, y, z, radius (mm) of a trunk, 10 mm long, and straight branches of 10 mm; lines begin at the inlet, or each at the end of
    the trunk, `gap` above it."""
    trunk = [(0, 0, z, 2) for z in range(11)]
    lines = [] if repeated else [trunk]
    for k in range(outlets):
        x, y = math.cos(2 * math.pi * k / outlets), math.sin(2 * math.pi * k / outlets)
        branch = [(0.6 * i * x, 0.6 * i * y, 10 + 0.8 * i, 1.5) for i in range(1, 11)]
        lines.append(trunk + branch if repeated else [(0, 0, 10 + gap * (k > 0), 1.5), *branch])
    return [numpy.array(line, float) for line in lines]


def compressed(text):
    """A VTP file with its arrays compressed, as writers do by default."""

    def pack(match):
        data = base64.b64decode(match.group(1))[8:]
        packed = zlib.compress(data)
        return f">{base64.b64encode(struct.pack('<4Q', 1, len(data), 0, len(packed))).decode()}{base64.b64encode(packed).decode()}</DataArray>"

    return re.sub(r">([\w+/=]+)</DataArray>", pack, text).replace("<VTKFile ", '<VTKFile compressor="vtkZLibDataCompressor" ')


def appended(text):
    """A VTP file with its arrays as raw bytes behind the tags."""
    blocks = []

    def move(match):
        offset = sum(map(len, blocks))
        blocks.append(base64.b64decode(match.group(1)))
        return f'format="appended" offset="{offset}"/>'

    tags = re.sub(r'format="binary">([\w+/=]+)</DataArray>', move, text).encode()
    return tags.replace(b"</VTKFile>", b'<AppendedData encoding="raw">_' + b"".join(blocks) + b"</AppendedData></VTKFile>")


@unittest.skipUnless(HAS_PARAVIEW, "built without ParaView")
class CentreLines(NetworkCase):
    def write_lines(self, lines, inlet, outlet, name="n.vtp"):
        """Lines of rows x, y, z, radius, with a pressure at the first point of all and one at the last of each."""
        rows = numpy.vstack(lines)
        offsets = numpy.cumsum([len(line) for line in lines])
        pressure = numpy.full(len(rows), numpy.nan)
        pressure[0] = inlet
        begins = {tuple(line[0][:3]) for line in lines}
        for line, end in zip(lines, offsets):
            if tuple(line[-1][:3]) not in begins:
                pressure[end - 1] = outlet
        write_vtp(self.path / name, rows[:, :3].copy(), numpy.arange(len(rows)), offsets, {"radius": rows[:, 3].copy(), "pressure_condition": pressure}, {})

    def run_lines(self):
        self.write("n.toml", SCENE)
        result = self.run_well("n.toml", "-o", "out", "--set", "insitu.enabled=false")
        return self.record("out")["results"]["network"], result.stdout + result.stderr

    def test_flows_of_a_y_and_of_an_arch(self):
        for shape, vessels in (("Y", y_network()), ("arch", arch_network())):
            truth = inflow_of(lines_of(vessels, "once"), INLET_PRESSURE, OUTLET_PRESSURE)
            for style in STYLES:
                with self.subTest(shape, style=style):
                    write_centre_lines(self.path / "n.vtp", vessels, lines_of(vessels, style))
                    network, told = self.run_lines()
                    self.assertEqual(network["vessels"], len(lines_of(vessels, "once")))
                    self.assertLess(abs(network["inflow_m3_s"] / truth - 1), OFF[style])
                    self.assertEqual("repeat earlier lines and are left out" in told, style != "once")
                    self.assertNotIn("no condition", told)

    def test_a_trunk_is_counted_once_and_gaps_are_closed(self):
        # name, lines, inflow (L/min), how far it may be off, what is told
        cases = [("five outlets", spokes(5), 8.937, "40 segments of 4 lines repeat earlier lines"),
                 ("no gap", spokes(2, repeated=False), 5.560, ""),
                 ("a gap of 1e-6 mm", spokes(2, 1e-6, repeated=False), 5.560, "joined across a gap of at most"),
                 ("a gap of 1e-3 mm", spokes(2, 1e-3, repeated=False), 5.560, "joined across a gap of at most")]  # fmt: skip
        for name, lines, litres, sentence in cases:
            with self.subTest(name):
                self.write_lines(lines, 13332, 12000)
                network, told = self.run_lines()
                self.assertEqual(network["vessels"], 6 if len(lines) == 5 else 3)
                self.assertLess(abs(network["inflow_m3_s"] / (litres * L_PER_MIN) - 1), 1e-4)
                self.assertIn(sentence, told)
        truth = inflow_of([spokes(5)[0], *(line[10:] for line in spokes(5)[1:])], 13332, 12000)
        self.assertAlmostEqual(truth / L_PER_MIN, 8.937, delta=5e-4)

    def test_every_encoding_is_read(self):
        vessels = y_network()
        write_centre_lines(self.path / "n.vtp", vessels, lines_of(vessels, "repeated"))
        text = (self.path / "n.vtp").read_text()
        plain = self.run_lines()[0]["inflow_m3_s"]
        for data in (compressed(text).encode(), appended(text)):
            (self.path / "n.vtp").write_bytes(data)
            self.assertEqual(self.run_lines()[0]["inflow_m3_s"], plain)

    def test_a_branch_is_screened_and_coupled_by_its_name(self):
        vessels = arch_network()
        lines = lines_of(vessels, "jitter")
        write_centre_lines(self.path / "n.vtp", vessels, lines)
        self.write("n.toml", SCENE)
        self.run_well("n.toml", "-o", "out", "--set", "insitu.enabled=false", "--set", "screening.top=9")
        with open(self.path / "out/screening.csv", encoding="utf-8") as file:
            names = {row["vessel"] for row in csv.DictReader(file)}
        self.assertEqual(len(names), 9)
        self.assertIn("1", names)  # the second line's own branch: what it does not share with the first
        self.write("c.toml", SCENE.replace('"network"', '"coupled"', 1) + '[coupling]\nvessel = "1"\nradius_of = "narrowest"\n'
                   '[discretisation]\nparticles = 6000\n[load]\nramp_time = "20 us"\n[time]\nend = "20 us"\n')  # fmt: skip
        result = self.run_well("c.toml", "-o", "coupled", "--set", "insitu.enabled=false")
        chosen = self.record("coupled")["results"]["coupling"]["vessel"]
        carotid = lines_of(vessels, "once")[list(vessels).index("carotid") + 3]  # the arch has four stretches
        radii = [cone_radius(a, b) for a, b in zip(carotid[:, 3], carotid[1:, 3])]
        self.assertAlmostEqual(chosen["radius_m"], MM * min(radii), delta=1e-6)
        self.assertIn("the narrowest of", result.stdout)
        pressures = self.record("coupled")["results"]["coupling"]["net_pressure_Pa"]
        self.assertTrue(INLET_PRESSURE > pressures[0] > pressures[1] > pressures[2] > OUTLET_PRESSURE - 1, pressures)

    def test_files_that_take_vtk_out_of_its_memory_are_refused(self):
        vessels = y_network()
        write_centre_lines(self.path / "n.vtp", vessels, lines_of(vessels, "once"))
        good = (self.path / "n.vtp").read_text()
        self.write("n.toml", SCENE)
        points = re.search(r'NumberOfPoints="\d+"', good).group()
        radius = re.search(r"<DataArray[^>]*MaximumInscribedSphereRadius.*?</DataArray>\n", good).group()
        # what is changed, into what, what the message says
        cases = [(points, 'NumberOfPoints="-1"', "NumberOfPoints = -1 is no number"),
                 (points, 'NumberOfPoints="-2147483648"', "NumberOfPoints = -2147483648"),
                 (points, 'NumberOfPoints="4294967296"', "bytes cannot hold"),
                 ('NumberOfVerts="0"', 'NumberOfVerts="4294967296"', "bytes cannot hold"),
                 ('NumberOfVerts="0"', 'NumberOfVerts="-1"', "NumberOfVerts = -1"),
                 ('NumberOfLines="3"', 'NumberOfLines=""', "no lines"),
                 ('NumberOfLines="3"', 'NumberOfLines="4294967296"', "bytes cannot hold"),
                 ('NumberOfLines="3"', 'NumberOfLines="300"', "n.vtp"),
                 ('NumberOfPolys="0"', 'NumberOfPolys="4294967296"', "bytes cannot hold"),
                 ('Radius" NumberOfComponents="1"', 'Radius" NumberOfComponents="4294967296"', "4294967296 components"),
                 ('Radius" NumberOfComponents="1"', 'Radius" NumberOfComponents="0"', "0 components"),
                 ('Name="pressure_condition"', 'Name="MaximumInscribedSphereRadius"', "two arrays"),
                 ("<CellData></CellData>", f"<CellData>{radius}{radius}</CellData>", "two arrays"),
                 ("UInt64", "UInt32", "n.vtp"),
                 ("</VTKFile>", "", "n.vtp")]  # fmt: skip
        for old, new, fragment in cases:
            with self.subTest(new):
                self.assertIn(old, good)
                self.write("n.vtp", good.replace(old, new, 1))
                for ranks in (None, 2) if "-1" in new else (None,):  # VTK's process is another one under mpirun
                    self.assert_refused(self.rhexis("run", "n.toml", ranks=ranks), ["n.vtp", fragment], new, ["n.toml", "n.vtp"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
