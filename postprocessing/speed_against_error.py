#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Speed against error: work-precision diagrams and tables of the discretisations there are, measured here and now.

    ./quickstart test     # builds what this runs
    postprocessing/speed_against_error.py [--build build/release] [--repeat 3] [--skip elasticity|onsets] [-o results/speed_against_error]

Elasticity. Error: relative L2 error of the static radial displacement against Lame's plane-strain solution. Work: core-seconds
of solving for each millisecond of the paper's vessel (10 mm), from runs of some hundred steps on one thread; the cases take
turns, and the median counts. The paper's step (500 ns at 100 um) is 0.161 of its stable one, ours is 0.65.

Onset. Pressure at which a scattered wall (1.5 mm, endless) begins to rupture on a ramp, with the horizon held at 350 um and the
paper's dead load for all, against ours at REFERENCE spacings across the wall; as the pressure rises in proportion to time, the error of the moment is the same. Work:
core-seconds of solving up to it, on one thread, the least of the repetitions: what else runs on the machine only adds. Some six minutes
for each repetition, and three for the reference, once.
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

from onset import OURS, PAPER, ROOT, onset, settings

WALL = 0.5e-3  # m
SERIES = {  # name: scheme, horizon in spacings, share of the stable step, bonds, spacings across the wall
    "the paper's scheme": (PAPER, 3.5, 0.161, "single", (3, 5, 7, 10, 14)),
    "the same, step 0.65": (PAPER, 3.5, 0.65, "single", (5, 10)),
    "lattice, energy correction": (("lattice", "energy", "consistent"), 3.5, 0.65, "single", (5, 10)),
    "ours": (OURS, 3.5, 0.65, "single", (3, 4, 5, 7, 10)),
    "ours, step 0.4": (OURS, 3.5, 0.4, "single", (5,)),
    "ours, double bonds": (OURS, 3.5, 0.65, "double", (5,)),
    "ours, horizon 2.5": (OURS, 2.5, 0.65, "single", (5, 10)),
    "ours, horizon 5": (OURS, 5, 0.65, "single", (5, 10)),
}
REFERENCE = 11  # spacings across the wall: the horizon may be 8 of them
ONSETS = {  # name: scheme, share of the stable step, spacings across the wall, what else is set
    "the paper's scheme": (PAPER, 0.161, (5, 7, 10), ()),
    "the same, step 0.65": (PAPER, 0.65, (5, 7, 10), ()),
    "the same, lattice shifted": (PAPER, 0.65, (5, 7), ("discretisation.lattice_shift=[0.0, 0.0]",)),
    "ours": (OURS, 0.65, (4, 5, 7, 10), ()),
    "ours, step 0.4": (OURS, 0.4, (5,), ()),
    "ours, step 0.2": (OURS, 0.2, (5,), ()),
    "ours, double bonds": (OURS, 0.65, (5,), ("discretisation.bond_precision=double",)),
    "ours, turned by 1 deg": (OURS, 0.65, (5, 7), ("discretisation.rotation=1 deg",)),
    "ours, turned by 2 deg": (OURS, 0.65, (5, 7), ("discretisation.rotation=2 deg",)),
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
                         f"discretisation.horizon_ratio={ratio}", *settings(scheme), f"discretisation.bond_precision={bonds}"):
            command += ["--set", override]
        subprocess.run(command, check=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
        record = json.loads((pathlib.Path(folder) / "run.json").read_text())
    return record["performance"]["solve_s"] / (record["results"]["simulated_s"] * 1e3)


def report(path, header, rows):
    with open(path, "w", encoding="utf-8") as file:
        csv.writer(file).writerows([header, *rows])
    for row in (header, ["---"] * len(header), *rows):
        print("| " + " | ".join(map(str, row)) + " |")


def elasticity(build, repeat, output):
    cases = [(name, scheme, ratio, share, bonds, n) for name, (scheme, ratio, share, bonds, across) in SERIES.items() for n in across]
    errors = {case: error(build, case[1], case[2], case[5]) for case in cases}
    times = {case: [] for case in cases}
    for _ in range(repeat):
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
    report(output / "table.csv",
           ["scheme", "across the wall", "spacing (um)", "error (%)", "core-s per ms", "range", "over ours at no larger error"], rows)

    figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
    for name in SERIES:
        of_series = [case for case in cases if case[0] == name]
        axes.loglog([cost[c] for c in of_series], [100 * errors[c] for c in of_series], "o-", label=name)
    axes.set(xlabel="core-seconds per simulated millisecond", ylabel="error against Lame (%)")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(output / "work_precision.png", dpi=150)
    print(output / "work_precision.png")


def onsets(build, repeat, output):
    os.environ["OMP_NUM_THREADS"] = "1"

    def found(scheme, share, more, across):
        return onset(build, *settings(scheme), "load.direction=dead", "vessel.length=1.5 mm", "discretisation.horizon=350 um",
                     f"discretisation.spacing={WALL / across!r} m", f"time.step_fraction={share}", *more)

    reference = found(OURS, 0.65, (), REFERENCE)
    cases = [(name, n) for name, (_, _, across, _) in ONSETS.items() for n in across]
    runs = {case: [] for case in cases}
    for _ in range(repeat):
        for name, n in cases:
            scheme, share, _, more = ONSETS[name]
            runs[name, n].append(found(scheme, share, more, n))
    errors = {case: 100 * (runs[case][0]["kPa"] / reference["kPa"] - 1) for case in cases}
    times = {case: [run["core_s"] for run in runs[case]] for case in cases}
    cost = {case: min(times[case]) for case in cases}
    row = lambda name, n, at: [name, n, f"{1e6 * WALL / n:.0f}", f"{at['kPa']:.2f}", f"{at['step_kPa']:.2f}"]
    report(output / "onset.csv",
           ["scheme", "across the wall", "spacing (um)", "onset (kPa)", "a step's share (kPa)", "error (%)", "core-s to onset", "at most"],
           [*(row(*case, runs[case][0]) + [f"{errors[case]:+.2f}", f"{cost[case]:.3g}", f"{max(times[case]):.3g}"]
              for case in cases), row("reference", REFERENCE, reference) + ["-", f"{reference['core_s']:.3g}", "-"]])

    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    markers = {4: "v", 5: "o", 7: "s", 10: "^"}
    for name, (_, _, across, _) in ONSETS.items():
        if "turned" in name:  # on top of the others
            continue
        line, = axes.loglog([cost[name, n] for n in across], [abs(errors[name, n]) for n in across], label=name)
        for n in across:
            axes.loglog(cost[name, n], abs(errors[name, n]), markers[n], color=line.get_color())
    axes.axhline(100 * reference["step_kPa"] / reference["kPa"], color="k", ls=":", lw=1, label="one time step of 0.65")
    shapes = [axes.plot([], [], marker, color="grey", label=f"spacing {1e6 * WALL / n:.0f} um")[0] for n, marker in markers.items()]
    axes.set(xlabel="core-seconds up to the onset", ylabel="error of the onset of rupture (%)")
    axes.grid(True, which="both", alpha=0.3)
    axes.margins(y=0.2)
    axes.add_artist(axes.legend(handles=shapes, fontsize=8, loc="lower left"))
    axes.legend(handles=[line for line in axes.lines if not line.get_label().startswith(("_", "spacing"))], fontsize=8)
    figure.savefig(output / "onset_work_precision.png", dpi=150)
    print(output / "onset_work_precision.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--repeat", type=int, default=3, help="of every run whose time counts")
    parser.add_argument("--skip", choices=("elasticity", "onsets"))
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/speed_against_error")
    options = parser.parse_args()
    build = options.build.resolve()
    options.output.mkdir(parents=True, exist_ok=True)
    if options.skip != "elasticity":
        elasticity(build, options.repeat, options.output)
    if options.skip != "onsets":
        onsets(build, options.repeat, options.output)


if __name__ == "__main__":
    main()
