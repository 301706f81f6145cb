# SPDX-License-Identifier: BSD-3-Clause
"""A wall of some hundred particles under a sudden pressure, to which a test adds [time] and [output]."""

SMALL_TUBE = """\
[vessel]
inner_radius = "0.3 mm"
outer_radius = "0.6 mm"
length = "1.2 mm"

[discretisation]
spacing = "100 um"

[load]
pressure = "20 kPa"
schedule = "step"

"""
