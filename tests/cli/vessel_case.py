# SPDX-License-Identifier: BSD-3-Clause
"""One small vessel, and what tests of it have in common."""

import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest

RHEXIS, *MPIRUN = sys.argv[1:]

# A vessel small enough to run in a second: 548 columns x 20 rows, no pictures.
GOOD = """\
[vessel]
inner_radius = "1.5 mm"
outer_radius = "2 mm"
length = "2 mm"

[discretisation]
spacing = "100 um"

[load]
pressure = "238 kPa"
ramp_time = "0.1 ms"
venting = "none"

[time]
step = "500 ns"
end = "50 us"

[output]
every_steps = 20
"""


def replaced(line_start, new):
    return "\n".join(new if line.startswith(line_start) else line for line in GOOD.splitlines()) + "\n"


class VesselCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="rhexis_cli_")
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, text, name="vessel.toml"):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return name

    def rhexis(self, *arguments, ranks=None):
        launcher = [*MPIRUN, "-n", str(ranks)] if ranks else []
        return subprocess.run([*launcher, RHEXIS, *arguments], cwd=self.folder.name, capture_output=True, text=True,
                              timeout=300, stdin=subprocess.DEVNULL, check=False)

    def record(self, folder):
        with open(self.path(folder + "/run.json"), encoding="utf-8") as file:
            return json.load(file)

    def history(self, folder):
        with open(self.path(folder + "/history.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))
