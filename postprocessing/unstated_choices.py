#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Which choice that the paper leaves open moves which of its figures: a table, measured.

    postprocessing/unstated_choices.py [-o results/unstated_choices]

Runs inputs/perivessel.toml once as it is and once for each change of a single choice, without pictures, and writes
table.md and table.csv. Some fifteen runs of a quarter of a minute on two cores.
"""

import argparse
import csv
import pathlib

from places import RESULTS, ROOT

import rhexis

# What is changed, and how.
CHOICES = [
    ("as in inputs/perivessel.toml", {}),
    ("ends free", {"boundary.ends": "free"}),
    ("ends sliding", {"boundary.ends": "sliding"}),
    ("endless vessel", {"boundary.ends": "axial_periodic"}),
    ("layer consistent", {"load.layer": "consistent"}),
    ("Eq. (8) read literally: particles in the lumen, too, a horizon deep, and the layer there",
     {"vessel.inner_radius": "1.15 mm", "load.layer_thickness": "0.35 mm"}),
    ("lattice shifted half a spacing", {"discretisation.lattice_shift": [0.0, 0.0]}),
    ("polar cross-section", {"discretisation.cross_section": "polar", "discretisation.surface_correction": "none"}),
    ("our discretisation", {"discretisation.cross_section": "polar", "load.layer": "nonlocal"}),
    ("pressure at once", {"load.schedule": "step"}),
    ("smooth ramp", {"load.schedule": "smooth_ramp"}),
    ("pressure on the deformed lumen", {"load.direction": "follower"}),
    ("our discretisation, pressure on the deformed lumen",
     {"discretisation.cross_section": "polar", "load.layer": "nonlocal", "load.direction": "follower"}),
    ("venting", {"load.venting": "orifice"}),
    ("double-precision bonds", {"discretisation.bond_precision": "double"}),
]

COLUMNS = ["choice", "first break (ms)", "damage 0.2 at (ms)", "u_max then (mm)", "u_max at 2.1 ms (mm)",
           "length at 2.1 ms (mm)", "u_max at end (mm)", "damage at end (%)", "length at end (mm)"]


def shown(value, factor, digits=2):
    return "-" if value is None else f"{float(value) * factor:.{digits}f}"


def measure(folder, overrides):
    results = rhexis.run(ROOT / "inputs/perivessel.toml", {"output.fields": []} | overrides, output=folder)
    with open(folder / "history.csv", encoding="utf-8") as file:
        at = min(csv.DictReader(file), key=lambda row: abs(float(row["time_s"]) - 2.1e-3))
    return [shown(results["first_bond_break_s"], 1e3), shown(results["rupture_onset_s"], 1e3),
            shown(results["max_displacement_at_onset_m"], 1e3), shown(at["max_displacement_m"], 1e3),
            shown(at["rupture_length_m"], 1e3, 1), shown(results["max_displacement_m"], 1e3),
            shown(results["max_damage"], 100, 0), shown(results["rupture_length_m"], 1e3, 1)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=RESULTS / "unstated_choices")
    options = parser.parse_args()

    rows = []
    for number, (name, overrides) in enumerate(CHOICES):
        print(f"{number + 1}/{len(CHOICES)}  {name}", flush=True)
        rows.append([name, *measure(options.output / f"{number:02d}", overrides)])
    rows.append(["paper", "-", "1.85", "0.5", "-", "-", "2", "47", "8"])

    lines = ["| " + " | ".join(row) + " |" for row in [COLUMNS, ["---"] * len(COLUMNS), *rows]]
    (options.output / "table.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    with open(options.output / "table.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([COLUMNS, *rows])
    print("\n".join(lines))


if __name__ == "__main__":
    main()
