#!/usr/bin/env python3
"""Speed against error of the discretisations there are: a table, measured here and now.

    postprocessing/speed_against_error.py [--build build/release] [--repeat 3]

Error: relative L2 error of the static radial displacement against Lame's plane-strain solution, from the test `lame`
(build it with ./quickstart test). Speed: median of steps/s over the first 0.2 ms of inputs/perivessel.toml, without
output, the cases taking turns.
"""

import argparse
import json
import pathlib
import re
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

CASES = [  # cross-section, layer, bonds
    ("lattice", "paper", "single"),
    ("lattice", "consistent", "single"),
    ("polar", "consistent", "single"),
    ("lattice", "paper", "double"),
]


def errors(build):
    """Relative errors by (cross-section, layer), as the test prints them."""
    output = subprocess.run([build / "bin/lame"], capture_output=True, text=True, check=True).stdout
    return {tuple(key.split()): float(value) for key, value in re.findall(r"^(\w+ \w+): relative L2 error (\S+)", output, re.M)}


def speed(build, cross_section, layer, bonds):
    with tempfile.TemporaryDirectory(prefix="rhexis_speed_") as folder:
        command = [build / "bin/rhexis", "run", ROOT / "inputs/perivessel.toml", "-o", folder, "--quiet"]
        for override in ("insitu.enabled=false", "output.fields=[]", "output.every_steps=100000", "time.end=200 us",
                         f"discretisation.cross_section={cross_section}", f"load.layer={layer}",
                         f"discretisation.bond_precision={bonds}"):
            command += ["--set", override]
        subprocess.run(command, check=True)
        record = json.loads((pathlib.Path(folder) / "run.json").read_text())
    return record["results"]["steps"] / record["performance"]["solve_s"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    error = errors(options.build)
    speeds = {case: [] for case in CASES}
    for _ in range(options.repeat):
        for case in CASES:
            speeds[case].append(speed(options.build, *case))
    reference = statistics.median(speeds[CASES[0]])
    print("| cross-section | layer | bonds | error against Lame | steps/s | relative |")
    print("| --- | --- | --- | --- | --- | --- |")
    for case in CASES:
        median = statistics.median(speeds[case])
        print(f"| {' | '.join(case)} | {100 * error[case[:2]]:.1f} % | {median:.0f} | {median / reference:.2f} |")


if __name__ == "__main__":
    main()
