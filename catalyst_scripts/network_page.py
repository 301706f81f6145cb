# SPDX-License-Identifier: BSD-3-Clause
"""Catalyst script of `rhexis network --picture`: vessels in the colours of their radii, with the network's ends.

Without paraview.simple, which takes half a second to load: see network_picture.py.
"""

import math
import os

import numpy
from paraview.modules.vtkPVPythonCatalyst import vtkCPPythonScriptV2Helper
from vtkmodules.util.numpy_support import vtk_to_numpy

from network_picture import NetworkPicture
from picture_sheet import even_decades
from picture_tools import VIRIDIS, colours

network_fields = ["radius", "end"]
image_directory = ""  # the program puts a folder here
producer = vtkCPPythonScriptV2Helper.GetActiveInstance().GetTrivialProducer("network").GetClientSideObject()

MICROMETRE, MILLIMETRE = (1e-6, "\u00b5m"), (1e-3, "mm")
ENDS = [(1, "end with a condition", (0.13, 0.13, 0.13)), (2, "end without", (0.90, 0.30, 0.0))]
HALF_SIZE = 4.5  # of an end's mark, in pixels


class RadiiPicture(NetworkPicture):
    """One view, in which the colour tells the radius; marks tell which ends have a condition."""

    layouts = [[((0, 100, 1280, 570), (180, 56, 480))]]

    def draw_views(self, network, mesh, table):
        _, (left, y, width) = self.framing.layout[0]
        radius = table[:, 6].astype(float)
        unit, name = MICROMETRE if radius.max() < 1e-3 else MILLIMETRE
        steps, written = even_decades(radius.min() / unit, radius.max() / unit)
        low, high = math.log10(steps[0]), math.log10(steps[-1])
        shades = colours(VIRIDIS[::-1], "RGB")
        shades.SetRange(low, high)
        logarithm = numpy.log10(numpy.maximum(radius / unit, steps[0]))
        self.show(0, mesh.surface(logarithm[mesh.vessel].astype(numpy.float32)), shades)
        ticks = [((math.log10(step) - low) / (high - low), f"{step:g}") for step in written]
        self.sheet.colour_bar(left, y, width, shades, f"radius / {name}", ticks)
        self._mark_ends(network, left + width + 300, y)

    def _mark_ends(self, network, centre, y):
        left, bottom, width, height = self.framing.layout[0][0]
        middle = numpy.array([left + 0.5 * width, bottom + 0.5 * height])
        end = vtk_to_numpy(network.GetPointData().GetArray("end"))
        places = middle + self.framing.project(vtk_to_numpy(network.GetPoints().GetData()).astype(float))[:, :2]
        entries = []
        for kind, meaning, colour in ENDS:
            marked = places[end == kind]
            if len(marked) == 0:
                continue
            for size, shade in ((HALF_SIZE + 1.5, (1.0, 1.0, 1.0)), (HALF_SIZE, colour)):
                self.sheet.boxes(numpy.column_stack([marked - size, marked + size]), [shade] * len(marked))
            entries.append((f"{meaning} ({len(marked):,})", colour))
        self.sheet.key(centre, y, entries)


picture = RadiiPicture()


def catalyst_execute(info):
    picture.save(os.path.join(image_directory, "network_page.png"), producer.GetOutputDataObject(0), info.time)
