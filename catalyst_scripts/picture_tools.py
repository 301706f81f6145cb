# SPDX-License-Identifier: BSD-3-Clause
"""What the pictures of vessels and of networks have in common: numbers of all ranks, colours, text, PNG files."""

import math
import struct
import zlib

import numpy
import vtkmodules.vtkRenderingFreeType
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (it and FreeType: how VTK draws)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkFloatArray, vtkLookupTable
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

WIDTH, HEIGHT = 1280, 720  # even numbers, as movies need them
VIRIDIS = [
    (0.267, 0.005, 0.329), (0.283, 0.141, 0.458), (0.254, 0.265, 0.530), (0.207, 0.372, 0.553), (0.164, 0.471, 0.558),
    (0.128, 0.567, 0.551), (0.135, 0.659, 0.518), (0.267, 0.749, 0.441), (0.478, 0.821, 0.318), (0.741, 0.873, 0.150),
    (0.993, 0.906, 0.144),
]  # fmt: skip


def controller_of_ranks():
    """None where there is one rank only."""
    controller = vtkMultiProcessController.GetGlobalController()
    return None if controller is None or controller.GetNumberOfProcesses() == 1 else controller


def reduce_over_ranks(values, operation):
    """Element-wise minimum or maximum over all ranks."""
    controller = controller_of_ranks()
    if controller is None:
        return numpy.array(values, float)
    send, receive = vtkDoubleArray(), vtkDoubleArray()
    for value in values:
        send.InsertNextValue(value)
    receive.SetNumberOfValues(len(values))
    controller.AllReduce(send, receive, operation)
    return vtk_to_numpy(receive).copy()


def gather(table):
    """The rows of all ranks' tables (of floats) on the first rank, None on the others."""
    controller = controller_of_ranks()
    if controller is None:
        return table
    receive = vtkFloatArray()
    receive.SetNumberOfComponents(table.shape[1])
    controller.GatherV(numpy_to_vtk(table), receive, 0)
    return vtk_to_numpy(receive) if controller.GetLocalProcessId() == 0 else None


def round_up(value):
    """The next number of 1, 2, 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= value * (1 - 1e-9))


def colours(shades, space):
    """A table of 256 colours between shades of equal distances."""
    function = vtkColorTransferFunction()
    function.SetColorSpace({"RGB": 0, "Lab": 2}[space])
    for number, shade in enumerate(shades):
        function.AddRGBPoint(number / (len(shades) - 1), *shade)
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for number in range(256):
        table.SetTableValue(number, *function.GetColor(number / 255))
    return table


def plain(style, size):
    style.SetColor(0.0, 0.0, 0.0)
    style.SetFontFamilyToArial()
    style.SetFontSize(size)
    style.BoldOff()
    style.ItalicOff()
    style.ShadowOff()


def write_png(path, rows):
    """Twice as fast as VTK's writer (at its fastest), and what goes wrong is raised."""
    height, width, _ = rows.shape
    lines = numpy.empty((height, 1 + 3 * width), numpy.uint8)
    lines[:, 0] = 2  # the filter "up": each line as the difference from the one above
    lines[0, 1:] = rows[0].reshape(-1)
    numpy.subtract(rows[1:], rows[:-1], out=lines[1:, 1:].reshape(height - 1, width, 3))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)  # 8 bits of red, green and blue
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, content in ((b"IHDR", header), (b"IDAT", zlib.compress(lines, 1)), (b"IEND", b"")):
            file.write(struct.pack(">I", len(content)) + kind + content)
            file.write(struct.pack(">I", zlib.crc32(content, zlib.crc32(kind))))


def field_value(particles, name):
    """A number that goes with the particles (e.g. "pressure", in Pa), None where there is none of this name."""
    array = particles.GetFieldData().GetArray(name)
    return None if array is None else array.GetTuple1(0)
