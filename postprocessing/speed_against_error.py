#!/usr/bin/python3
"""Speed against error: work-precision diagram and table of the discretisations there are, measured here and now.

    ./quickstart test     # builds what this runs
    postprocessing/speed_against_error.py [--build build/release] [--repeat 3] [-o results/speed_against_error]

Error: relative L2 error of the static radial displacement against Lame's plane-strain solution. Work: core-seconds of
solving for each millisecond of the paper's vessel (10 mm), from runs of some hundred steps on one thread; the cases take
turns, and the median counts. The paper's step is a quarter of its stable one (500 ns), ours is 0.8.
"""

import argparse
import csv
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

import matplotlib

matplotlib.use("Agg")  # no display needed

import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent
WALL = 0.5e-3  # m
PAPER = ("lattice", "none", "paper")
OURS = ("polar", "calibrated", "nonlocal")
SERIES = {  # name: scheme, horizon in spacings, share of the stable step, bonds, spacings across the wall
    "the paper's scheme": (PAPER, 3.5, 0.25, "single", (3, 5, 7, 10, 14)),
    "the same, step 0.8": (PAPER, 3.5, 0.8, "single", (5, 10)),
    "lattice, energy correction": (("lattice", "energy", "consistent"), 3.5, 0.8, "single", (5, 10)),
    "ours": (OURS, 3.5, 0.8, "single", (3, 4, 5, 7, 10)),
    "ours, step 0.4": (OURS, 3.5, 0.4, "single", (5,)),
    "ours, double bonds": (OURS, 3.5, 0.8, "double", (5,)),
    "ours, horizon 2.5": (OURS, 2.5, 0.8, "single", (5, 10)),
    "ours, horizon 5": (OURS, 5, 0.8, "single", (5, 10)),
}


def error(build, scheme, ratio, across):
    output = subprocess.run([build / "bin/verification", "elasticity", *scheme, str(across), str(ratio)], capture_output=True, text=True, check=True)
    header, values = output.stdout.split()
    return dict(zip(header.split(","), map(float, values.split(","))))["error"]


def work(build, scheme, ratio, share, bonds, across):
    """Core-seconds a simulated millisecond."""
    with tempfile.TemporaryDirectory(prefix="rhexis_work_") as folder:
        command = [build / "bin/rhexis", "run", ROOT / "inputs/perivessel.toml", "-o", folder, "--quiet"]
        # Short runs: as many steps for coarse walls as a second allows.
        end = 200e-6 * (5 / across) ** 3
        for override in ("insitu.enabled=false", "output.fields=[]", "output.every_steps=1000000", f"time.end={end!r} s",
                         "load.ramp_time=2.25 ms", "time.step=auto", f"time.step_fraction={share}",
                         f"discretisation.spacing={WALL / across!r} m", "discretisation.horizon=auto",
                         f"discretisation.horizon_ratio={ratio}", f"discretisation.cross_section={scheme[0]}",
                         f"discretisation.surface_correction={scheme[1]}", f"load.layer={scheme[2]}",
                         f"discretisation.bond_precision={bonds}"):
            command += ["--set", override]
        subprocess.run(command, check=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
        record = json.loads((pathlib.Path(folder) / "run.json").read_text())
    return record["performance"]["solve_s"] / (record["results"]["simulated_s"] * 1e3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/speed_against_error")
    options = parser.parse_args()
    build = options.build.resolve()
    options.output.mkdir(parents=True, exist_ok=True)
    cases = [(name, scheme, ratio, share, bonds, n) for name, (scheme, ratio, share, bonds, across) in SERIES.items() for n in across]
    errors = {case: error(build, case[1], case[2], case[5]) for case in cases}
    times = {case: [] for case in cases}
    for _ in range(options.repeat):
        for case in cases:
            times[case].append(work(build, *case[1:]))
    cost = {case: statistics.median(values) for case, values in times.items()}

    # What the paper's scheme takes over the cheapest of ours that is no further off.
    ours = [case for case in cases if case[0] == "ours"]
    rows = []
    for case in cases:
        no_worse = [cost[other] for other in ours if errors[other] <= errors[case]]
        rows.append([case[0], case[5], f"{1e6 * WALL / case[5]:.0f}", f"{100 * errors[case]:.2f}", f"{cost[case]:.3g}",
                     f"{min(times[case]):.3g}-{max(times[case]):.3g}", f"{cost[case] / min(no_worse):.3g}" if no_worse else "-"])
    header = ["scheme", "across the wall", "spacing (um)", "error (%)", "core-s per ms", "range", "over ours at no larger error"]
    with open(options.output / "table.csv", "w", encoding="utf-8") as file:
        csv.writer(file).writerows([header, *rows])
    for row in (header, ["---"] * len(header), *rows):
        print("| " + " | ".join(map(str, row)) + " |")

    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    for name in SERIES:
        of_series = [case for case in cases if case[0] == name]
        axes.loglog([cost[c] for c in of_series], [100 * errors[c] for c in of_series], "o-", label=name)
    axes.set(xlabel="core-seconds per simulated millisecond", ylabel="error against Lame (%)")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=8)
    figure.savefig(options.output / "work_precision.png", dpi=150)
    print(options.output / "work_precision.png")


if __name__ == "__main__":
    main()
