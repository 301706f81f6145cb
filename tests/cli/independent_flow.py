# SPDX-License-Identifier: BSD-3-Clause
"""Flows in networks by an independent solver: Poiseuille's law and dense elimination, in Python."""

import math

import numpy

MMHG, UM, MM, CM = 133.322387415, 1e-6, 1e-3, 1e-2  # Pa, m
NL_PER_MIN = 1e-12 / 60  # m3/s
VISCOSITY = 3.5e-3  # Pa s, the program's default
EXACT = 1e-9  # the largest relative error: conditions and lengths have rounding in their units


def solve(vessels, pressures, inflows=None, viscosities=None):
    """Flows (m3/s) of vessels (from, to, radius, length; m), given pressures (Pa) and inflows (m3/s) at junctions."""
    number = {name: i for i, name in enumerate(sorted({end for vessel in vessels for end in vessel[:2]}))}
    ends = numpy.array([(number[a], number[b]) for a, b, _, _ in vessels])
    radius, length = numpy.array([vessel[2:] for vessel in vessels]).T
    conductance = math.pi * radius**4 / (8 * (VISCOSITY if viscosities is None else numpy.array(viscosities)) * length)
    matrix, right = numpy.zeros((len(number), len(number))), numpy.zeros(len(number))
    for (a, b), g in zip(ends, conductance):
        matrix[[a, b], [a, b]] += g
        matrix[[a, b], [b, a]] -= g
    for name, inflow in (inflows or {}).items():
        right[number[name]] = inflow
    for name, pressure in pressures.items():
        matrix[number[name]] = 0
        # Scaled as the other rows are, so that elimination compares like with like.
        matrix[number[name], number[name]] = conductance.mean()
        right[number[name]] = conductance.mean() * pressure
    p = numpy.linalg.solve(matrix, right)
    return list(conductance * (p[ends[:, 0]] - p[ends[:, 1]]))


def cone_radius(a, b):
    """The radius of the cylinder that resists as a cone from radius a to b does: 1 / r^4 is the mean along it."""
    return ((a * a + a * b + b * b) / (3 * a**3 * b**3)) ** -0.25
