#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How onset, number and size of cracks depend on the scatter of the wall: a table and a picture, measured here and now.

    postprocessing/heterogeneity_study.py [--seeds N] [-o results/heterogeneity]

Runs a short endless piece of the vessel of inputs/perivessel.toml (polar cross-section, consistent load, venting) with
several scatters, for several seeds each, and writes table.md and walls.png: the damage of each first seed's wall, laid
flat. Some 30 runs of a few seconds each.

A crack is a set of particles of damage >= 0.2 in adjoining cells of 1.5 spacings.
"""

import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")  # no display needed

import matplotlib.pyplot as pyplot
import numpy

from places import RESULTS, ROOT

import rhexis

RAMP_S, PRESSURE_PA = 1.8e-3, 320e3
LENGTH_M, SPACING_M = 4e-3, 1e-4
VESSEL = {"discretisation.cross_section": "polar", "load.layer": "consistent", "load.venting": "orifice",
          "boundary.ends": "axial_periodic", "vessel.length": f"{LENGTH_M} m", "discretisation.spacing": f"{SPACING_M} m",
          "load.pressure": f"{PRESSURE_PA} Pa", "load.ramp_time": f"{RAMP_S} s", "time.step": "auto", "time.end": f"{RAMP_S} s",
          "output.fields": [], "output.every_steps": 1000000}  # the first and the last step
RUPTURED = 0.2  # damage

# Scatter of critical stretch and stiffness, law, correlation length in mm.
CASES = [(0, 0, "lognormal", 0.25)] + [
    (stretch, 0, "lognormal", 0.25) for stretch in (0.01, 0.03, 0.1)] + [
    (0, stiffness, "lognormal", 0.25) for stiffness in (0.01, 0.03, 0.1)] + [
    (0.03, 0, "lognormal", length) for length in (0.5, 1.0)] + [
    (0.1, 0, "weibull", 0.25)]

COLUMNS = ["critical stretch", "stiffness", "law", "correlation (mm)", "onset (kPa)", "cracks", "longest (mm)",
           "rupture length (mm)", "broken bonds (%)"]


def cracks(points):
    """Number of connected sets of points [n, 3] in a wall that is periodic along z, and the axial length of the
    longest, m."""
    layers = int(LENGTH_M / (1.5 * SPACING_M))
    cells = numpy.floor(points / (1.5 * SPACING_M)).astype(int)
    cells[:, 2] = points[:, 2] * layers / LENGTH_M
    occupied = set(map(tuple, cells))
    steps = [(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
    number, longest = 0, 0
    while occupied:
        number += 1
        reached, heights = [occupied.pop()], set()
        while reached:
            x, y, z = reached.pop()
            heights.add(z)
            near = {(x + i, y + j, (z + k) % layers) for i, j, k in steps} & occupied
            occupied -= near
            reached.extend(near)
        longest = max(longest, len(heights))
    return number, longest * LENGTH_M / layers


def measure(folder, case, seed):
    """The numbers of one run, and its wall: reference positions [n, 3] in m and damage [n] at the end."""
    stretch, stiffness, law, length = case
    wall = []

    def keep(particles, _):
        points = numpy.subtract(particles["position"], particles["displacement"]).T
        wall[:] = points, particles["damage"].copy()

    scatter = {"scatter.critical_stretch": stretch, "scatter.stiffness": stiffness, "scatter.law": law,
               "scatter.correlation_length": f"{length} mm", "scatter.seed": seed}
    results = rhexis.run(ROOT / "inputs/perivessel.toml", VESSEL | scatter, output=folder, progress=keep)
    points, damage = wall
    number, longest = cracks(points[damage >= RUPTURED])
    onset = results["rupture_onset_s"]
    broken = int((folder / "history.csv").read_text(encoding="utf-8").splitlines()[-1].split(",")[5])
    return [float("nan") if onset is None else onset / RAMP_S * PRESSURE_PA / 1e3, number, 1e3 * longest,
            1e3 * results["rupture_length_m"], 100 * broken / results["bonds"]], wall


def shown(values, digits):
    """The mean, and the range where there is one."""
    mean, low, high = (f"{x:.{digits}f}" for x in (numpy.mean(values), min(values), max(values)))
    return mean if low == high else f"{mean} ({low} to {high})"


def draw(axes, case, wall):
    points, damage = wall
    order = numpy.argsort(damage)
    angle = numpy.degrees(numpy.arctan2(points[order, 1], points[order, 0]))
    dots = axes.scatter(1e3 * points[order, 2], angle, c=damage[order], s=0.5, vmin=0, vmax=0.5, cmap="inferno_r",
                        rasterized=True)
    stretch, stiffness, law, length = case
    axes.set_title(f"stretch {stretch}, stiffness {stiffness}\n{law}, {length} mm", fontsize=8)
    return dots


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=RESULTS / "heterogeneity")
    options = parser.parse_args()

    figure, axes = pyplot.subplots(2, (len(CASES) + 1) // 2, figsize=(14, 6), sharex=True, sharey=True,
                                   layout="constrained", squeeze=False)
    rows = []
    for number, case in enumerate(CASES):
        seeds = range(1, 1 + (options.seeds if case[0] or case[1] else 1))
        runs = [measure(options.output / f"{number:02d}_{seed}", case, seed) for seed in seeds]
        numbers = [shown(values, digits) for values, digits in
                   zip(zip(*(run[0] for run in runs)), (1, 0, 1, 1, 1))]
        rows.append([*map(str, case), *numbers])
        print(f"{number + 1}/{len(CASES)}  " + "  ".join(rows[-1]), flush=True)
        dots = draw(axes.flat[number], case, runs[0][1])
    figure.supxlabel("along the axis (mm)")
    figure.supylabel("around the axis (degrees)")
    figure.colorbar(dots, ax=axes, label="damage")
    figure.savefig(options.output / "walls.png", dpi=150)

    lines = ["| " + " | ".join(row) + " |" for row in [COLUMNS, ["---"] * len(COLUMNS), *rows]]
    (options.output / "table.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
