#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Two runs of one input, say on two machines or by two compilers: how far their results are from each other.

    postprocessing/compare_runs.py FOLDER OTHER_FOLDER [--tolerance 0] [--picture-tolerance 0.01]

Compares every column of history.csv, every number among the results in run.json, every dataset of the HDF5 files and
every picture. The difference of numbers is relative to the largest of the column or dataset; that of pictures is the
mean over pixels and colours, from 0 to 1. Status 1: something differs by more than the tolerances, or is there once only.
"""

import argparse
import csv
import json
import pathlib
import sys

import h5py
import matplotlib.image
import numpy as np


def difference(one, other):
    """The largest difference of two arrays of numbers, relative to the largest number; infinite for two shapes."""
    if one.shape != other.shape:
        return np.inf
    if one.dtype.kind not in "fiu":
        return 0.0 if np.array_equal(one, other) else np.inf
    both_nan = np.isnan(one) & np.isnan(other)
    scale = max(np.abs(one[~np.isnan(one)]).max(initial=0.0), np.abs(other[~np.isnan(other)]).max(initial=0.0))
    apart = np.where(both_nan | (one == other), 0.0, np.abs(np.asarray(one, float) - other))
    worst = apart.max(initial=0.0)
    return np.inf if np.isnan(worst) else worst / scale if worst else 0.0


def numbers_in(value, name=""):
    """Every number of a JSON value, by its path."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from numbers_in(item, f"{name}.{key}" if name else key)
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from numbers_in(item, f"{name}[{index}]")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield name, np.array(value, float)


def history(path):
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in (rows[0] if rows else {})}


def results(path):
    return dict(numbers_in(json.loads(path.read_text(encoding="utf-8")).get("results", {})))


def datasets(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: np.asarray(item[()])}) if isinstance(item, h5py.Dataset) else None)
    return found


def picture(path):
    return {"pixels": matplotlib.image.imread(path)}


def picture_difference(one, other):
    return np.inf if one.shape != other.shape else float(np.abs(one - other).mean())


# Files of a results folder, how their values are read, by name, and how two of these are compared.
KINDS = (("history.csv", history, difference), ("run.json", results, difference), ("*.h5", datasets, difference),
         ("images/**/*.png", picture, picture_difference))


def compare(folder, other):
    """Yields (file, name of a value, difference) of all kinds of files; infinite where one of the folders lacks it."""
    for pattern, read, differ in KINDS:
        files = sorted({path.relative_to(root) for root in (folder, other) for path in root.glob(pattern)})
        for file in files:
            if not ((folder / file).exists() and (other / file).exists()):
                yield file, "(in one folder only)", np.inf
                continue
            ours, theirs = read(folder / file), read(other / file)
            for name in sorted(ours.keys() | theirs.keys()):
                both = name in ours and name in theirs
                yield file, name, differ(ours[name], theirs[name]) if both else np.inf


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs=2, type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--tolerance", type=float, default=0.0, help="of numbers (default: 0, identical)")
    parser.add_argument("--picture-tolerance", type=float, default=0.01, help="of pictures (default: 0.01)")
    options = parser.parse_args()
    compared = list(compare(*options.folders))
    if not compared:
        sys.exit(f"error: no results in {options.folders[0]} and {options.folders[1]}")
    beyond = 0
    for kind, tolerance in (("numbers", options.tolerance), ("pictures", options.picture_tolerance)):
        values = [entry for entry in compared if (entry[0].suffix == ".png") == (kind == "pictures")]
        far = [entry for entry in values if entry[2] > tolerance]
        print(f"{kind}: {sum(entry[2] == 0 for entry in values)} of {len(values)} identical, "
              f"largest difference {max((entry[2] for entry in values), default=0.0):.3g}, {len(far)} beyond {tolerance:g}")
        for file, name, apart in sorted(far, key=lambda entry: -entry[2])[:20]:
            print(f"  {file} {name}: {apart:.3g}")
        beyond += len(far)
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main())
