# SPDX-License-Identifier: BSD-3-Clause
"""Networks that tests of the program run: scenes, files, and what these tests have in common."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

RHEXIS, SOURCE, *MPIRUN = sys.argv[1:]
# With ParaView there are pictures, and VTK to read its files.
HAS_PARAVIEW = "Catalyst" in subprocess.run([RHEXIS, "--version"], capture_output=True, text=True, check=True).stdout

TREE = """\
[scene]
model = "network"

[tree]
generations = 12
root_radius = "2 mm"
asymmetry = 0.9
least_asymmetry = 0.4
length_spread = 0.2

[flow]
inlet_pressure = "90 mmHg"
outlet_pressure = "5 mmHg"

[network]
query = ["artery.", "vein.0110", "4095"]
shown_vessels = 300
"""
JUNCTIONS = "id,x [mm],y [mm],z [mm],pressure [mmHg]\na,0,0,0,10\nb,3,4,0,\nc,3,4,12,0\n"
VESSELS = "id,from,to,radius [um]\n1,a,b,50\n2,b,c,40\n"
FILES = """\
[scene]
model = "network"
[network]
source = "file"
files = ["j.csv", "v.csv"]
"""


def tree(line_start, new):
    return "\n".join(new if line.startswith(line_start) else line for line in TREE.splitlines()) + "\n"


class NetworkCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="rhexis_network_")
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def write(self, name, text):
        (self.path / name).write_text(text, encoding="utf-8")

    def rhexis(self, *arguments, ranks=None):
        launcher = [*MPIRUN, "-n", str(ranks)] if ranks else []
        return subprocess.run([*launcher, RHEXIS, *arguments], cwd=self.path, capture_output=True, text=True, timeout=300,
                              stdin=subprocess.DEVNULL, check=False)

    def run_well(self, *arguments, ranks=None):
        result = self.rhexis("run", *arguments, ranks=ranks)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def record(self, folder):
        return json.loads((self.path / folder / "run.json").read_text())

    def assert_refused(self, result, fragments, name, files):
        self.assertEqual(result.returncode, 2, f"{name}: {result.stderr}")
        self.assertEqual(result.stderr.count("rhexis: "), 1, f"{name}: not one message: {result.stderr}")
        for fragment in fragments:
            self.assertIn(fragment, result.stderr, name)
        self.assertEqual(sorted(os.listdir(self.path)), sorted(files), f"{name}: something was written")
