# SPDX-License-Identifier: BSD-3-Clause
"""The comparison with LAMMPS: what it says where LAMMPS is absent, what it writes for it, and, where it is there, that
both codes agree on a tiny vessel.

Run by ctest as: test_peers.py RHEXIS SOURCE_DIR
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

RHEXIS, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SCRIPT = SOURCE / "postprocessing/compare_peers.py"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPT.parent))

import compare_peers
import lammps_peri


class Absent(unittest.TestCase):
    def test_says_what_to_install(self):
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder) / "peers"
            done = subprocess.run([sys.executable, SCRIPT, "-o", output], env={"PATH": folder}, capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn("apt-get install lammps", done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1)
            self.assertFalse(output.exists())


class Writer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.wall = compare_peers.wall(RHEXIS, "vessel.length=1.2 mm")

    def test_data_file_holds_the_wall(self):
        header, atoms = lammps_peri.data_text(self.wall).split("Atoms # peri\n\n")
        rows = np.array([line.split() for line in atoms.splitlines()], dtype=float)
        self.assertIn(f"{len(rows)} atoms", header)
        self.assertEqual(len(rows), 548 * 12)
        np.testing.assert_array_equal(rows[:, 0], np.arange(1, len(rows) + 1))
        np.testing.assert_allclose(rows[:, 2], 1e-12, rtol=1e-12)  # (100 um)^3
        np.testing.assert_allclose(rows[:, 3], 1300, rtol=1e-12)
        np.testing.assert_array_equal(rows[:, 4:], self.wall.positions)

    def test_ends_and_layer(self):
        types = self.wall.types()
        self.assertEqual((types == lammps_peri.HELD).sum(), 548 * 8)  # 4 rows, the horizon, at each end
        radius = np.hypot(*self.wall.positions[:, :2].T)
        loaded = types == lammps_peri.LOADED
        self.assertLessEqual(radius[loaded].max(), 1.85e-3 * (1 + 1e-9))
        self.assertGreater(radius[types == lammps_peri.FREE].min(), 1.85e-3)
        self.assertEqual(self.wall.ring().sum(), 548)

    def test_input_has_material_and_load(self):
        text = lammps_peri.input_text(self.wall, 10, 1e-7)
        words = next(line.split() for line in text.splitlines() if line.startswith("pair_coeff"))
        constant = 12 * 3.5e6 / (np.pi * 350e-6**4)
        np.testing.assert_allclose([float(word) for word in words[3:]], [constant, 350e-6, 0.25, 0], rtol=1e-12)
        self.assertAlmostEqual(self.wall.pressure_rate / (238e3 / 2.25e-3), 1, places=12)


@unittest.skipUnless(shutil.which("lmp"), "LAMMPS is not installed")
class Agreement(unittest.TestCase):
    def test_motion_before_rupture(self):
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder)
            options = type("Options", (), {"cores": 1, "length": 1.2, "end": 0.05, "every": 20, "output": output,
                                           "lammps": compare_peers.lammps()})
            histories, events = compare_peers.physics(options, RHEXIS)
        differences = compare_peers.deviations(histories, compare_peers.MATCHED, 1)
        for name, difference in differences.items():
            self.assertLess(difference, 1e-5, name)  # single precision against double
        self.assertIsNone(events[compare_peers.MATCHED]["first_break_s"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
