# SPDX-License-Identifier: BSD-3-Clause
"""Networks with one vessel that has a wall: scenes, and what tests of them have in common."""

import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor

import h5py

RHEXIS, *MPIRUN = sys.argv[1:]

MMHG = 133.322387415  # Pa
BLOOD_VISCOSITY, BLOOD_DENSITY, DISCHARGE = 3.5e-3, 1060, 0.62  # Pa s, kg/m3: the program's defaults

# Three vessels in a row, the middle one of 144 columns x 24 rows: a second for a run.
JUNCTIONS = """\
id,x [mm],y [mm],z [mm],pressure [mmHg]
heart,-100,0,0,200
neck,-2,10,0,
brain,4,20,0,
vein,50,0,0,20
"""
VESSELS = """\
id,from,to,radius [mm],length [mm],wall_thickness [mm]
feeder,heart,neck,1.2,300,0.4
artery,neck,brain,1.5,6,0.75
bed,brain,vein,0.3,50,0.1
"""
TWO_WAY = """\
[scene]
model = "coupled"

[network]
source = "file"
files = ["j.csv", "v.csv"]

[blood]
viscosity_law = "constant"

[coupling]
vessel = "artery"
mode = "two_way"
window = "20 us"

[material]
critical_stretch = 0.015

[discretisation]
cross_section = "lattice"
spacing = "250 um"

[load]
layer = "consistent"
schedule = "smooth_ramp"
ramp_time = "0.8 ms"

[time]
step = "5 us"
end = "1.6 ms"

[output]
every_steps = 4
precision = "double"
"""
TREE = """\
[scene]
model = "coupled"

[tree]
generations = 12
root_radius = "2 mm"
asymmetry = 0.9
least_asymmetry = 0.4

[wall]
artery_ratio = 0.75

[flow]
inlet_pressure = "200 mmHg"
outlet_pressure = "5 mmHg"

[coupling]
vessel = "artery.0"

[discretisation]
particles = 3200

[time]
end = "0.2 ms"

[output]
every_steps = 50
"""


def changed(text, key, new):
    """`text` with another line for the one of `key`."""
    lines = text.splitlines()
    (place,) = (i for i, line in enumerate(lines) if line.startswith(f"{key} ="))
    return "\n".join([*lines[:place], new, *lines[place + 1:]]) + "\n"


ONE_WAY = changed(TWO_WAY, "mode", "")


def resistance(radius, length):
    return 8 * BLOOD_VISCOSITY * length / (math.pi * radius**4)


FEEDER, ARTERY, BED = resistance(1.2e-3, 0.3), resistance(1.5e-3, 6e-3), resistance(0.3e-3, 0.05)


def at_once(function, argument_lists):
    """What `function` returns for each: starting a program is mostly waiting."""
    with ThreadPoolExecutor(4) as pool:
        return list(pool.map(lambda arguments: function(*arguments), argument_lists))


class CoupledCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="rhexis_coupled_")
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        self.write({"j.csv": JUNCTIONS, "v.csv": VESSELS})

    def write(self, files):
        for name, text in files.items():
            (self.path / name).write_text(text, encoding="utf-8")

    def rhexis(self, *arguments, ranks=None, threads=None, cwd=None):
        launcher = [*MPIRUN, "-n", str(ranks)] if ranks else []
        environment = {**os.environ, **({"OMP_NUM_THREADS": str(threads)} if threads else {})}
        # Launchers that start and end at once make and remove each other's folder of sessions.
        with tempfile.TemporaryDirectory() as sessions:
            environment["OMPI_MCA_orte_tmpdir_base"] = sessions
            return subprocess.run([*launcher, RHEXIS, *arguments], cwd=cwd or self.path, capture_output=True, text=True,
                                  timeout=300, stdin=subprocess.DEVNULL, env=environment, check=False)

    def run_well(self, scene, folder, *overrides, more=(), **launch):
        """Runs `scene` into `folder`; its results without what differs from run to run: times."""
        self.write({f"{folder}.toml": scene})
        settings = [word for override in overrides for word in ("--set", override)]
        result = self.rhexis("run", f"{folder}.toml", "--quiet", "-o", folder, *settings, *more, **launch)
        self.assertEqual(result.returncode, 0, result.stderr)
        record = json.loads((self.path / folder / "run.json").read_text())
        self.assertEqual(record["status"], "completed")
        for key in ("network_s", "exchange_s"):
            (record["results"]["coupling"] or {}).pop(key, None)
        return record["results"]

    def rows(self, file):
        with open(self.path / file, encoding="utf-8") as stream:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(stream)]

    def assert_close(self, a, b, relative, message=None):
        self.assertLessEqual(abs(a - b), relative * abs(b), (a, b, message))

    def assert_same_data(self, a, b):
        """Every data set of two HDF5 files, bit for bit."""
        with h5py.File(self.path / a) as one, h5py.File(self.path / b) as other:
            names = [], []
            one.visit(names[0].append)
            other.visit(names[1].append)
            self.assertEqual(*names)
            data = [name for name in names[0] if isinstance(one[name], h5py.Dataset) and not name.endswith("unplanned")]
            self.assertGreater(len(data), 5)
            for name in data:
                self.assertEqual(one[name][()].tobytes(), other[name][()].tobytes(), name)
