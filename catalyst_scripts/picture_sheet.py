# SPDX-License-Identifier: BSD-3-Clause
"""What is written on a picture: text, colour bars, a scale bar, in pixels from the bottom left, y upwards."""

import math

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import VTK_INT, VTK_UNSIGNED_CHAR, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkPolyDataMapper2D, vtkRenderer, vtkTextActor

from picture_tools import plain, round_up

INK = (0.13, 0.13, 0.13)
SMALL, LARGE = 16, 20  # heights of letters
LENGTH_UNITS = [(1.0, "m"), (1e-2, "cm"), (1e-3, "mm"), (1e-6, "\u00b5m")]


class Sheet:
    """A transparent layer over a whole window, whose pixels are `fineness` times as fine as the sheet's."""

    def __init__(self, window, fineness):
        self.fineness = fineness
        self.layer = vtkRenderer()
        self.layer.SetLayer(1)
        window.SetNumberOfLayers(2)
        window.AddRenderer(self.layer)

    def clear(self):
        self.layer.RemoveAllViewProps()

    def text(self, x, y, line, size=SMALL, align="left"):
        actor = vtkTextActor()
        actor.SetInput(line)
        style = actor.GetTextProperty()
        plain(style, size * self.fineness)
        style.SetColor(*INK)
        style.SetJustification({"left": 0, "centre": 1, "right": 2}[align])
        actor.SetPosition(x * self.fineness, y * self.fineness)
        self.layer.AddActor2D(actor)

    def boxes(self, boxes, colours):
        """Rectangles (left, bottom, right, top), each of its colour (0 ... 1)."""
        left, bottom, right, top = numpy.array(boxes, float).T
        corners = numpy.stack([left, bottom, right, bottom, right, top, left, top], axis=1).reshape(-1, 2)
        self._quadrangles(corners, colours)

    def _quadrangles(self, corners, colours):
        corners = self.fineness * corners
        points = vtkPoints()
        points.SetData(numpy_to_vtk(numpy.column_stack([corners, numpy.zeros(len(corners))]), deep=True))
        numbers = numpy.arange(len(corners) + 1, dtype=numpy.int32)
        cells = vtkCellArray()
        cells.SetData(numpy_to_vtk(numbers[::4], True, VTK_INT), numpy_to_vtk(numbers[:-1], True, VTK_INT))
        shape = vtkPolyData()
        shape.SetPoints(points)
        shape.SetPolys(cells)
        shades = numpy.rint(255 * numpy.array(colours, float)).astype(numpy.uint8)
        shape.GetCellData().SetScalars(numpy_to_vtk(shades, True, VTK_UNSIGNED_CHAR))
        mapper = vtkPolyDataMapper2D()
        mapper.SetInputData(shape)
        actor = vtkActor2D()
        actor.SetMapper(mapper)
        self.layer.AddActor2D(actor)

    def ring(self, x, y, radius):
        """A circle with a white edge, to be seen on any colour."""
        angles = numpy.linspace(0, 2 * math.pi, 65)
        for inner, outer, colour in ((radius - 2.5, radius + 2.5, (1.0, 1.0, 1.0)), (radius - 1.25, radius + 1.25, INK)):
            edge = [numpy.column_stack([x + r * numpy.cos(angles), y + r * numpy.sin(angles)]) for r in (inner, outer)]
            corners = numpy.stack([edge[0][:-1], edge[1][:-1], edge[1][1:], edge[0][1:]], axis=1).reshape(-1, 2)
            self._quadrangles(corners, [colour] * (len(angles) - 1))

    def key(self, centre, y, entries):
        """A row of coloured squares with their meaning: entries (name, colour), centred about `centre`."""
        widths = [40 + 0.55 * SMALL * len(name) for name, _ in entries]
        x = centre - 0.5 * sum(widths)
        for (name, colour), width in zip(entries, widths):
            self.boxes([(x, y, x + 16, y + 16)], [colour])
            self.text(x + 24, y + 2, name)
            x += width

    def colour_bar(self, left, y, width, table, title, ticks):
        """A horizontal bar of a lookup table with its title above; ticks: (place 0 ... 1, label) below."""
        count = table.GetNumberOfTableValues()
        edges = left + width * numpy.arange(count + 1) / count
        self.boxes(
            [(a, y, b, y + 14) for a, b in zip(edges, edges[1:])],
            [table.GetTableValue(number)[:3] for number in range(count)],
        )
        self.boxes([(left + width * place - 0.75, y - 5, left + width * place + 0.75, y) for place, _ in ticks],
                   [INK] * len(ticks))  # fmt: skip
        for place, label in ticks:
            self.text(left + width * place, y - 21, label, align="centre")
        self.text(left + 0.5 * width, y + 22, title, align="centre")

    def scale_bar(self, left, y, pixels_per_m, about):
        """A line of a round length, of about this many pixels, with its length above."""
        length_m = round_up(0.4 * about / pixels_per_m)
        unit_m, unit = next((u for u in LENGTH_UNITS if u[0] <= length_m * (1 + 1e-9)), LENGTH_UNITS[-1])
        self.boxes([(left, y, left + length_m * pixels_per_m, y + 3)], [INK])
        self.text(left, y + 9, f"{length_m / unit_m:g} {unit}")


def even_ticks(low, high, about):
    """Round numbers that take in both ends, with about as many steps between them."""
    if not high - low > 1e-6 * max(abs(low), abs(high), 1e-9):
        margin = max(1.0, 0.05 * abs(low))
        low, high = low - margin, high + margin
    rough = (high - low) / about
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1, 2, 2.5, 5, 10) if factor * power >= rough * (1 - 1e-9))
    first, last = math.floor(low / step + 1e-6), math.ceil(high / step - 1e-6)
    return [number * step for number in range(first, last + 1)]


def even_decades(low, high, most=6):
    """Numbers 1, 2, 5 times powers of ten that take in both ends, and those of them to be written: at most seven.

    What is more than `most` powers of ten below the high end is left out.
    """
    powers = range(math.floor(math.log10(high)) - most - 1, math.ceil(math.log10(high)) + 1)
    steps = [float(f"{factor}e{power}") for power in powers for factor in (1, 2, 5)]
    low, high = max(low, high / 10.0**most), min(step for step in steps if step >= high * (1 - 1e-6))
    low = max(step for step in steps if step <= min(low, 0.5 * high) * (1 + 1e-6))
    steps = [step for step in steps if low <= step <= high]
    return steps, steps if len(steps) <= 7 else [step for step in steps if f"{step:e}"[0] == "1"]
