# SPDX-License-Identifier: BSD-3-Clause
"""Whole runs at the edge: time steps beyond the stable one, and pressures from 1 Pa to 1 GPa.

Run by ctest as: test_hard_runs.py RHEXIS
"""

import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy

from study.tube import SMALL_TUBE

RHEXIS = sys.argv[1]

TUBE = SMALL_TUBE + """\
[time]
end = "0.4 ms"

[output]
every_steps = 20
"""


class HardRuns(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rhexis_hard_")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        with open(os.path.join(self.folder, "tube.toml"), "w", encoding="utf-8") as file:
            file.write(TUBE)

    def rhexis(self, command, *sets):
        overrides = [word for key_value in sets for word in ("--set", key_value)]
        return subprocess.run([RHEXIS, command, "tube.toml", *overrides], cwd=self.folder, capture_output=True,
                              text=True, timeout=300, stdin=subprocess.DEVNULL, check=False)

    def record(self):
        with open(os.path.join(self.folder, "results/tube/run.json"), encoding="utf-8") as file:
            return json.load(file)

    def assert_readable(self):
        """What was saved is whole: rows of numbers, and particles of each of their moments."""
        with open(os.path.join(self.folder, "results/tube/history.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertGreater(len(rows), 0)
        for row in rows:
            self.assertTrue(all(math.isfinite(float(value)) for value in row.values()), row)
        with h5py.File(os.path.join(self.folder, "results/tube/particles.h5")) as file:
            for row in rows:
                self.assertTrue(numpy.isfinite(file[f"displacement/{int(row['step']):06d}"][:]).all())
        return rows

    def stable_step_us(self):
        said = self.rhexis("check").stdout
        self.assertRegex(said, r"instability +begins at .* times the stable step")
        return float(re.search(r"of the stable ([\d.]+) us\)", said).group(1))

    def test_steps_around_the_stable_one(self):
        stable = self.stable_step_us()
        run = self.rhexis("run", f"time.step={0.95 * stable} us")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertLess(abs(self.record()["results"]["energy_drift"]), 0.05)

        refused = self.rhexis("run", f"time.step={1.05 * stable} us")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("time.step", refused.stderr)

        # The computed step is a bound, below the true limit: a little beyond it, nothing happens.
        forced = self.rhexis("run", f"time.step={1.05 * stable} us", "time.allow_unstable=true")
        self.assertEqual(forced.returncode, 0, forced.stderr)
        self.assertLess(abs(self.record()["results"]["energy_drift"]), 0.05)

    def test_blow_up_is_noticed_and_what_was_saved_is_readable(self):
        stable = self.stable_step_us()
        run = self.rhexis("run", f"time.step={2.5 * stable} us", "time.allow_unstable=true")
        self.assertEqual(run.returncode, 3, run.stdout)
        self.assertRegex(run.stderr, r"became unstable by step \d+ .*; use a smaller time\.step")
        self.assertLessEqual(int(re.search(r"by step (\d+)", run.stderr).group(1)), 20)
        self.assertTrue(self.record()["status"].startswith("failed: the run became unstable"))
        self.assert_readable()

    def test_balance_after_the_first_step_of_a_ramp_is_no_blow_up(self):
        # All the wall has then is what half a step has given it, ahead of the work.
        run = self.rhexis("run", "load.schedule=ramp", "output.every_steps=1", "time.end=5 us")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertGreater(float(self.assert_readable()[1]["kinetic_J"]), 0)

    def test_quasi_static_start(self):
        run = self.rhexis("run", "load.schedule=ramp", "load.pressure=400 kPa", "load.ramp_time=4 ms",
                          "start.equilibrium_pressure=50 kPa")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stdout, r"start +equilibrium under 50 kPa: \d+ steps")
        rows = self.assert_readable()
        first, last = rows[0], rows[-1]
        self.assertEqual(float(first["time_s"]), 0)
        self.assertAlmostEqual(float(first["pressure_Pa"]), 50e3, delta=1)
        self.assertAlmostEqual(float(last["pressure_Pa"]), 50e3 + 100e6 * float(last["time_s"]), delta=1)
        self.assertEqual(float(first["kinetic_J"]), 0)
        self.assertAlmostEqual(float(first["external_work_J"]) / float(first["strain_J"]), 1, delta=1e-6)
        self.assertLess(abs(self.record()["results"]["energy_drift"]), 1e-3)

        for sets, status, words in ((("start.equilibrium_pressure=3 MPa", "load.pressure=3 MPa"), 3, ["does not bear", "lower pressure"]),
                                    (("start.equilibrium_pressure=30 kPa",), 2, ["start.equilibrium_pressure", "never reaches"])):
            run = self.rhexis("run", *sets)
            self.assertEqual(run.returncode, status, run.stderr)
            for word in words:
                self.assertIn(word, run.stderr)

    def test_onset_after_a_quasi_static_start_is_that_of_a_slow_ramp(self):
        # A wall whose first bond breaks at its onset, not long before.
        wall = ["discretisation.cross_section=lattice", "load.layer=consistent", "load.schedule=ramp", "load.pressure=800 kPa", "load.ramp_time=16 ms", "time.end=16 ms",
                "material.critical_stretch=0.1", "boundary.ends=axial_periodic", "output.fields=[]", "output.every_steps=100000"]
        pressure = lambda time_s: 800e3 * time_s / 16e-3
        self.rhexis("run", *wall)
        slow = self.record()["results"]["rupture_onset_s"]
        start = 0.85 * pressure(slow)
        run = self.rhexis("run", *wall, f"start.equilibrium_pressure={start} Pa", "time.end=3 ms")
        after = self.record()["results"]["rupture_onset_s"]
        step = self.record()["results"]["time_step_s"]
        relaxation = int(re.search(r": (\d+) steps of relaxation", run.stdout).group(1))
        difference = (start + pressure(after)) / pressure(slow) - 1
        print(f"\nonset at {pressure(slow):.0f} Pa, after the start {difference:+.1e} of it; {slow / step:.0f} steps against "
              f"{after / step:.0f} and {relaxation} of relaxation", file=sys.stderr)
        self.assertLess(abs(difference), 0.01)
        self.assertLess(after / step + relaxation, 0.3 * slow / step)

    def test_pressures_from_one_pascal_to_a_gigapascal(self):
        for pressure in ("1 Pa", "1 kPa", "1 MPa", "1 GPa"):
            with self.subTest(pressure):
                run = self.rhexis("run", f"load.pressure={pressure}")
                self.assertIn(run.returncode, (0, 3), run.stderr)
                if run.returncode == 3:
                    self.assertIn("unstable", run.stderr)
                rows = self.assert_readable()
                print(f"\n{pressure}: status {run.returncode}, {len(rows)} outputs, broken bonds {rows[-1]['broken_bonds']}, "
                      f"largest displacement {float(rows[-1]['max_displacement_m']):.3g} m", file=sys.stderr)
                self.assertEqual(int(rows[-1]["broken_bonds"]) > 0, pressure[2] in "MG")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
