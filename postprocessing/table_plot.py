# SPDX-License-Identifier: BSD-3-Clause
"""What scripts that draw a table of a run have in common: reading it, and the command line."""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no display needed

import numpy


def read(path):
    """Columns by name; an empty value is not a number."""
    table = numpy.genfromtxt(path, delimiter=",", names=True, dtype=float)
    if table.size == 0:
        raise ValueError("no rows")
    return {name: numpy.atleast_1d(table[name]) for name in table.dtype.names}


def main(description, name, what, plot):
    """Draws the table `name`.csv that the command line names, by plot(columns), which returns a figure."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("table", metavar=name, type=Path, help=f"{name}.csv of {what}")
    parser.add_argument("-o", "--output", type=Path, help=f"image to write (default: {name}.png beside it)")
    arguments = parser.parse_args()
    if not arguments.table.exists():
        sys.exit(f"error: no file {arguments.table}")
    output = arguments.output or arguments.table.with_suffix(".png")
    try:
        figure = plot(read(arguments.table))
    except (KeyError, IndexError, ValueError, TypeError, OSError) as error:
        sys.exit(f"error: {arguments.table} is not the {name}.csv of {what} ({error})")
    figure.savefig(output, dpi=150)
    print(output)
