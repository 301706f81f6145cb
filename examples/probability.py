#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""An ensemble of your own: how often does a wall of scattered strength tear? A few samples of a short, coarse vessel."""

import random

import rhexis

COARSE = {"vessel.length": "3 mm", "output.fields": []}

draw = random.Random(1)
torn = 0
for sample in range(1, 9):
    stretch = 0.25 * draw.lognormvariate(0, 0.1)
    results = rhexis.run("inputs/vented_vessel.toml", COARSE | {"material.critical_stretch": stretch})
    torn += results["rupture_onset_s"] is not None
    print(f"{torn} of {sample} walls tore; this one has a critical stretch of {stretch:.3f}")
