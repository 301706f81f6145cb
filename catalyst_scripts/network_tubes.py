# SPDX-License-Identifier: BSD-3-Clause
"""Vessels as round-ended tubes, made for one camera that looks down the z axis, all of a class at once.

A tube is a grid of points: rows along it (its two ends, and circles of the round caps beyond them), columns around
it. Thin tubes get the three columns that face the camera, which shade like a cylinder; thick ones go all around.
"""

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import VTK_INT, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

# From this radius in pixels on: columns around, degrees from the first to the last, circles of a cap.
CLASSES = [
    (0.0, 3, 180, []),
    (1.6, 5, 180, [45]),
    (4.0, 13, 360, [35, 70, 90]),
    (12.0, 25, 360, [22, 45, 68, 90]),
    (36.0, 61, 360, [10, 20, 30, 40, 50, 60, 70, 80, 90]),
]


def directions(axis):
    """Unit vectors across each tube: to the camera's side, and as nearly as can be towards the camera."""
    side = numpy.cross(axis, [0.0, 0.0, 1.0])
    width = numpy.linalg.norm(side, axis=1, keepdims=True)
    side = numpy.where(width > 1e-6, side / numpy.maximum(width, 1e-6), [1.0, 0.0, 0.0])
    return side, numpy.cross(side, axis)


def tubes(start, end, radius, columns, degrees, caps):
    """Points [N, rows, columns, 3], normals alike, and for each row whether it belongs to the start or the end (0, 1)."""
    axis = end - start
    length = numpy.linalg.norm(axis, axis=1, keepdims=True)
    axis = numpy.where(length > 0, axis / numpy.maximum(length, 1e-30), [1.0, 0.0, 0.0])
    side, facing = directions(axis)
    ends = numpy.array([0] * (len(caps) + 1) + [1] * (len(caps) + 1))
    lean = numpy.radians([-angle for angle in reversed(caps)] + [0, 0] + caps)[:, None, None]
    around = numpy.radians(numpy.linspace(-degrees / 2, degrees / 2, columns))[:, None]
    outward = numpy.cos(around) * facing[:, None, None] + numpy.sin(around) * side[:, None, None]
    normals = numpy.cos(lean) * outward + numpy.sin(lean) * axis[:, None, None]
    bases = numpy.stack([start, end], axis=1)[:, ends]
    return bases[:, :, None] + radius[:, None, None, None] * normals, normals, ends


def triangles(count, rows, columns):
    """Corners [T, 3] of `count` grids of points."""
    numbers = numpy.arange(rows * columns, dtype=numpy.int32).reshape(rows, columns)
    a, b, c, d = numbers[:-1, :-1], numbers[:-1, 1:], numbers[1:, 1:], numbers[1:, :-1]
    grid = numpy.stack([a, b, c, a, c, d], axis=-1).reshape(1, -1)
    return (grid + rows * columns * numpy.arange(count, dtype=numpy.int32)[:, None]).reshape(-1, 3)


class TubeMesh:
    """All tubes in one surface. Of each point: `vessel`, its number, and `at_end`, 0 or 1."""

    def __init__(self, start, end, radius):
        points, normals, corners, vessels, ends, offset = [], [], [], [], [], 0
        limits = [lower for lower, *_ in CLASSES[1:]]
        class_of = numpy.searchsorted(limits, radius, side="right")
        for number, (_, columns, degrees, caps) in enumerate(CLASSES):
            chosen = numpy.flatnonzero(class_of == number)
            if len(chosen) == 0:
                continue
            place, normal, end_of_row = tubes(start[chosen], end[chosen], radius[chosen], columns, degrees, caps)
            rows = len(end_of_row)
            points.append(place.reshape(-1, 3).astype(numpy.float32))
            normals.append(normal.reshape(-1, 3).astype(numpy.float32))
            corners.append(offset + triangles(len(chosen), rows, columns))
            vessels.append(numpy.repeat(chosen, rows * columns))
            ends.append(numpy.tile(numpy.repeat(end_of_row, columns), len(chosen)))
            offset += len(chosen) * rows * columns
        self.vessel, self.at_end = numpy.concatenate(vessels), numpy.concatenate(ends)
        self.points, self.cells = vtkPoints(), vtkCellArray()
        points = numpy.concatenate(points)
        self.low, self.high = points[:, 2].min(), points[:, 2].max()
        self.points.SetData(numpy_to_vtk(points, deep=True))
        self.normals = numpy_to_vtk(numpy.concatenate(normals), deep=True)
        corners = numpy.concatenate(corners).reshape(-1)
        starts = numpy.arange(0, len(corners) + 1, 3, dtype=numpy.int32)
        self.cells.SetData(numpy_to_vtk(starts, True, VTK_INT), numpy_to_vtk(corners, True, VTK_INT))

    def surface(self, values):
        """The surface with a value, or a colour (three bytes), at each point."""
        surface = vtkPolyData()
        surface.SetPoints(self.points)
        surface.SetPolys(self.cells)
        surface.GetPointData().SetNormals(self.normals)
        surface.GetPointData().SetScalars(numpy_to_vtk(values, deep=True))
        return surface
