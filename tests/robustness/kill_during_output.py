#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Kills runs at random moments and looks at what they leave: every listed step must be whole.

    tests/robustness/kill_during_output.py build/release/bin/rhexis [--kills 300] [--seed 1] [--launcher "mpirun -n 2"]

A small wall is stored at every step, as XDMF and as VTKHDF, by the program alone or under a launcher. SIGKILL ends it between
its start and its end. Then the .xdmf must be well-formed and the .vtkhdf must open, their steps must be those of the run, in
order, and all values of each must be those of a run that nobody killed. Ends with status 1 at the first that is not.
"""

import argparse
import os
import random
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy

WALL = """\
[vessel]
inner_radius = "1.5 mm"
outer_radius = "1.7 mm"
length = "1 mm"
[discretisation]
spacing = "100 um"
horizon = "210 um"
[load]
pressure = "100 kPa"
[time]
step = "200 ns"
end = "60 us"
[output]
every_steps = 1
format = "both"
fields = ["displacement", "damage"]
movie = false
[insitu]
enabled = false
"""


def xdmf_steps(folder):
    """{step: {dataset name without its place: values}} of what is listed."""
    path = folder / "particles.xdmf"
    if not path.exists():
        return {}
    steps = {}
    with h5py.File(folder / "particles.h5") as file:
        for grid in ElementTree.parse(path).getroot().iter("Grid"):
            if grid.get("GridType") != "Uniform":
                continue
            items = [item.text.split(":")[1] for item in grid.iter("DataItem") if item.get("Format") == "HDF"]
            step = int(grid.find("Information[@Name='step']").get("Value"))
            steps[step] = {name.split("/")[1]: file[name][:] for name in items}
    return steps


def vtkhdf_steps(folder):
    """The same of the other file."""
    path = folder / "particles.vtkhdf"
    if not path.exists() or not h5py.is_hdf5(path):
        return {}
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        count, points = root["Steps"].attrs["NSteps"], root["NumberOfPoints"][0]
        if len(root["Steps/Values"]) != count:
            sys.exit(f"error: {path}: NSteps is {count}, and there are {len(root['Steps/Values'])} times")
        names = {"position": root["Points"], "displacement": root["PointData/displacement"], "damage": root["PointData/damage"]}
        return {int(root["FieldData/step"][i]): {name: data[i * points:(i + 1) * points] for name, data in names.items()}
                for i in range(count)}


def run(command, folder, after=None):
    """Seconds that it took; killed `after` so many."""
    start = time.monotonic()
    process = subprocess.Popen([*command, "-o", str(folder)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        process.wait(after)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    else:
        if after is None and process.returncode:
            sys.exit(f"error: the run ended with status {process.returncode}")
    return time.monotonic() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rhexis", type=Path)
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--launcher", type=shlex.split, default=[], help="such as 'mpirun -n 2'")
    arguments = parser.parse_args()
    moments = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory(prefix="rhexis_kill_") as name:
        folder = Path(name)
        (folder / "wall.toml").write_text(WALL)
        command = [*arguments.launcher, arguments.rhexis.resolve(), "run", folder / "wall.toml", "--quiet"]
        took = run(command, folder / "whole")
        whole = xdmf_steps(folder / "whole")
        if not whole or whole.keys() != vtkhdf_steps(folder / "whole").keys():
            sys.exit("error: the whole run's two files list different steps")
        counts = []
        for kill in range(arguments.kills):
            at = folder / f"kill_{kill}"
            run(command, at, took * moments.uniform(0.02, 1))
            for steps in (xdmf_steps(at), vtkhdf_steps(at)):
                if list(steps) != list(whole)[:len(steps)]:
                    sys.exit(f"error: kill {kill}: steps {list(steps)}")
                for step, fields in steps.items():
                    for field, values in fields.items():
                        if field in whole[step] and not numpy.array_equal(values, whole[step][field]):
                            sys.exit(f"error: kill {kill}: {field} of step {step} is not that of the whole run")
                counts.append(len(steps))
            shutil.rmtree(at, ignore_errors=True)
    print(f"{arguments.kills} kills of a run of {len(whole)} outputs ({took:.1f} s): {min(counts)} to {max(counts)} steps listed, "
          f"{sum(counts)} in all, each of them whole")


if __name__ == "__main__":
    main()
