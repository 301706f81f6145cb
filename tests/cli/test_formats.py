# SPDX-License-Identifier: BSD-3-Clause
"""Results as XDMF and as VTKHDF hold the same, also after a restart, on more than one rank and of networks.

Run by ctest as: test_formats.py RHEXIS MPIRUN...
"""

import sys
import unittest
import xml.etree.ElementTree as ElementTree

import h5py
import numpy

from vessel_case import VesselCase, GOOD

TREE = """\
[scene]
model = "network"
[network]
shown_vessels = 100
[tree]
generations = 6
[flow]
inlet_pressure = "90 mmHg"
outlet_pressure = "10 mmHg"
[output]
format = "both"
"""
OLD = "cannot read VTKHDF files of particles and networks; 5.12 and later can"


class Formats(VesselCase):
    def run_well(self, *arguments, ranks=None):
        outcome = self.rhexis("run", *arguments, ranks=ranks)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)

    def assert_warned_as_due(self, folder):
        """An old ParaView is warned of, and no other."""
        version = self.rhexis("--version").stdout.partition("ParaView Catalyst ")[2].split()
        old = bool(version) and tuple(map(int, version[0].split(".")[:2])) < (5, 12)
        self.assertEqual(any(OLD in warning for warning in self.record(folder)["warnings"]), old)

    def assert_same(self, base, point_fields, cell_fields, moving):
        """All of <base>.vtkhdf is in <base>.h5 as well, at the steps that <base>.xdmf lists."""
        listed = [(float(grid.find("Time").get("Value")), int(grid.find("Information").get("Value")))
                  for grid in ElementTree.parse(self.path(base + ".xdmf")).getroot().iter("Grid") if grid.get("GridType") == "Uniform"]
        with h5py.File(self.path(base + ".h5")) as plain, h5py.File(self.path(base + ".vtkhdf")) as file:
            root = file["VTKHDF"]
            steps = root["Steps"]
            self.assertEqual(steps.attrs["NSteps"], len(listed))
            self.assertEqual(list(steps["Values"]), [time for time, _ in listed])
            self.assertEqual({*root["PointData"]}, {*point_fields} | ({"reference_position"} if moving else set()))
            self.assertEqual({*root["CellData"]}, {*cell_fields})
            points, cells = root["NumberOfPoints"][0], sum(root[kind]["NumberOfCells"][0] for kind in ("Vertices", "Lines"))
            for entry, (_, step) in enumerate(listed):
                self.assertEqual(root["FieldData/step"][entry], step)
                start = steps["PointOffsets"][entry]
                position = plain[f"position/{step:06d}"] if moving else plain["position"]
                self.assertTrue(numpy.array_equal(root["Points"][start:start + points], position))
                for group, count, fields in (("PointData", points, point_fields), ("CellData", cells, cell_fields)):
                    for field in fields:
                        start = steps[f"{group}Offsets/{field}"][entry]
                        values = root[group][field]
                        self.assertTrue(numpy.array_equal(values[start:start + count], plain[f"{field}/{step:06d}"]), (field, step))
                        self.assertEqual(values.attrs["unit"], plain[field].attrs["unit"])

    def test_particles_are_the_same_in_either_on_any_ranks_and_after_a_restart(self):
        self.write(GOOD + 'format = "both"\nfields = ["displacement", "damage"]\ncheckpoint_every = 50\n')
        self.run_well("vessel.toml", "-o", "one")
        self.assert_same("one/particles", ["displacement", "damage"], [], moving=True)
        self.assert_warned_as_due("one")
        with h5py.File(self.path("one/particles.vtkhdf")) as file:
            pressures = file["VTKHDF/FieldData/pressure"][:6]
        self.assertEqual([float(row["pressure_Pa"]) for row in self.history("one")], list(pressures))

        self.run_well("vessel.toml", "-o", "two", "--set", "output.format=vtkhdf", ranks=2)
        with open(self.path("one/particles.vtkhdf"), "rb") as one, open(self.path("two/particles.vtkhdf"), "rb") as two:
            self.assertTrue(one.read() == two.read())

        self.run_well("vessel.toml", "-o", "one", "--restart", "one/checkpoints/step_000050.h5")
        self.assert_same("one/particles_from_000050", ["displacement", "damage"], [], moving=True)
        self.assert_same("one/particles", ["displacement", "damage"], [], moving=True)

    def test_a_network_is_the_same_in_either(self):
        self.write(TREE, "n.toml")
        self.run_well("n.toml", "-o", "out")
        fields = ["pressure"]
        with h5py.File(self.path("out/network.h5")) as file:
            cell_fields = [name for name in file if name not in ("position", "connectivity", *fields)]
        self.assert_same("out/network", fields, cell_fields, moving=False)
        self.assert_warned_as_due("out")

    def test_what_has_no_effect_is_told_and_what_is_no_format_refused(self):
        self.write(GOOD + 'format = "vtk"\n')
        refused = self.rhexis("check", "vessel.toml")
        self.assertEqual(refused.returncode, 2)
        self.assertIn('"xdmf", "vtkhdf", "both"', refused.stderr)
        self.write(GOOD + 'format = "vtkhdf"\nfields = []\n')
        warnings = self.rhexis("check", "vessel.toml").stderr
        self.assertIn("output.format", warnings)
        self.assertIn("has no effect without output.fields", warnings)
        self.assertNotIn(OLD, warnings)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
