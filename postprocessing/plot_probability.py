#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Probability of rupture against pressure, from the table of an ensemble.

    postprocessing/plot_probability.py results/rupture_probability/probability.csv [-o probability.png]
"""

from table_plot import main  # before pyplot: settles how matplotlib draws

import matplotlib.pyplot as plt

MMHG = 133.322387415  # Pa


def plot(table):
    pressure = table["pressure_Pa"] / MMHG
    probability, low, high = (100 * table[name] for name in ("probability", "low_95", "high_95"))
    blue, red = "#1f5fa8", "#a8201f"
    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(7.2, 6.4), height_ratios=(3, 1), layout="constrained")
    top.fill_between(pressure, low, high, color=blue, alpha=0.18, linewidth=0, label="95 % confidence (Wilson)")
    samples = table["samples"].astype(int)
    walls = f"{samples[0]} walls" if (samples == samples[0]).all() else f"{samples.min()} to {samples.max()} walls"
    top.plot(pressure, probability, "o-", color=blue, markersize=4.5, linewidth=1.4, clip_on=False, zorder=3,
             label=f"share that ruptured, of {walls}")
    top.set_ylim(0, 100)
    top.set_ylabel("probability of rupture (%)")
    top.legend(frameon=False, loc="upper left")
    kilopascal = top.secondary_xaxis("top", functions=(lambda p: p * MMHG / 1e3, lambda p: p * 1e3 / MMHG))
    kilopascal.set_xlabel("pressure (kPa)")
    bottom.plot(pressure, 1e3 * table["mean_onset_s"], "s-", color=red, markersize=4, linewidth=1.4)
    bottom.set_ylabel("mean onset of\nthose (ms)")
    bottom.set_xlabel("pressure reached by the ramp (mmHg)")
    for axes in (top, bottom):
        axes.grid(alpha=0.3)
    return figure


main(__doc__, "probability", "an ensemble", plot)
