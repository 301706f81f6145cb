#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Curves over time from the history of a run.

    postprocessing/plot_history.py results/perivessel/history.csv [-o history.png]
"""

from table_plot import main  # before pyplot: settles how matplotlib draws

import matplotlib.pyplot as plt
import numpy


def two_axes(axes, time_ms, left, right):
    """Two curves that share the time axis; each is (values, label, colour)."""
    other = axes.twinx()
    for side, (values, label, colour) in ((axes, left), (other, right)):
        side.plot(time_ms, values, color=colour, linewidth=1.8)
        side.set_ylabel(label, color=colour)
        side.tick_params(axis="y", colors=colour)
        if numpy.nanmin(values, initial=0.0) >= 0:
            side.set_ylim(bottom=0)
    axes.grid(alpha=0.3)


def plot(history):
    time_ms = 1e3 * history["time_s"]
    figure, (top, middle, bottom) = plt.subplots(3, 1, sharex=True, figsize=(7.2, 8.4), layout="constrained")
    blue, red = "#1f5fa8", "#a8201f"
    two_axes(
        top,
        time_ms,
        (1e-3 * history["pressure_Pa"], "pressure (kPa)", blue),
        (1e3 * history["max_displacement_m"], "largest displacement (mm)", red),
    )
    two_axes(
        middle,
        time_ms,
        (history["max_damage"], "largest damage (fraction)", blue),
        (1e3 * history["rupture_length_m"], "rupture length (mm)", red),
    )
    for name, label, colour in (
        ("external_work_J", "work of the load", "#444444"),
        ("strain_J", "strain energy", blue),
        ("kinetic_J", "kinetic energy", red),
        ("fracture_J", "fracture energy", "#2f7d32"),
    ):
        bottom.plot(time_ms, 1e3 * history[name], label=label, color=colour, linewidth=1.8)
    bottom.set_ylabel("energy (mJ)")
    bottom.legend(frameon=False)
    bottom.grid(alpha=0.3)
    bottom.set_xlabel("time (ms)")
    return figure


main(__doc__, "history", "a run", plot)
