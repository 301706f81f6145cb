# SPDX-License-Identifier: BSD-3-Clause
"""Two runs compared: identical ones, one with a changed number, one with a file missing.

Run by ctest as: test_compare_runs.py RHEXIS MPIRUN...
"""

import pathlib
import shutil
import subprocess
import sys
import unittest

import h5py

from vessel_case import GOOD, VesselCase

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "postprocessing/compare_runs.py"


class CompareRuns(VesselCase):
    def compare(self, *arguments):
        return subprocess.run([sys.executable, SCRIPT, "one", *arguments], cwd=self.folder.name, capture_output=True, text=True,
                              check=False)

    def test_differences_are_found(self):
        self.write(GOOD)
        for name in ("one", "other"):
            result = self.rhexis("run", "vessel.toml", "-o", name)
            self.assertEqual(result.returncode, 0, result.stderr)
        same = self.compare("other")
        self.assertEqual(same.returncode, 0, same.stdout + same.stderr)
        self.assertRegex(same.stdout, r"numbers: (\d\d+) of \1 identical")

        shutil.copytree(self.path("other"), self.path("changed"))
        with h5py.File(self.path("changed/particles.h5"), "a") as file:
            displacement = file["displacement/000100"]
            displacement[...] = displacement[...] * 1.01
        changed = self.compare("changed")
        self.assertEqual(changed.returncode, 1, changed.stdout + changed.stderr)
        self.assertRegex(changed.stdout, r"particles\.h5 displacement/000100: 0\.0099")
        self.assertEqual(self.compare("changed", "--tolerance", "0.02").returncode, 0)

        pathlib.Path(self.path("changed/history.csv")).unlink()
        lacking = self.compare("changed", "--tolerance", "0.02")
        self.assertEqual(lacking.returncode, 1)
        self.assertIn("history.csv (in one folder only): inf", lacking.stdout)

    def test_folders_without_results(self):
        nothing = self.compare("other")
        self.assertEqual(nothing.returncode, 1)
        self.assertEqual(nothing.stderr, "error: no results in one and other\n")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
