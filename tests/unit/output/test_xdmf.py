# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's three XDMF readers, and its VTKHDF reader from 5.12 on, read the series of write_sample_series (argv[1]) and
write_sample_lines (argv[2]): steps, cells, values.
"""

import os
import subprocess
import sys
import tempfile

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

COLUMNS, ROWS, LINES = 5, 7, 13
STEPS = [0, 50, 73]


def expected(field, components, step, count=COLUMNS * ROWS):
    """As expected_value in synthetic_source.hpp."""
    values = []
    for point in range(count):
        base = len(field) * 4096 + point + 0.25 * (step % 4)
        values.append([base + 1024 * c for c in range(components)])
    return values


def leaf(data):
    """The first data set of a composite one."""
    while data.IsA("vtkMultiBlockDataSet"):
        data = data.GetBlock(0)
    return data


def steps_of(reader_name, path):
    """The reader's data at each of its steps, with the step."""
    reader = getattr(simple, reader_name)()
    reader.SetPropertyWithName("FileNames" if reader_name == "XDMFReader" else "FileName", [path])
    reader.UpdatePipelineInformation()
    times = list(reader.TimestepValues)
    assert times == [1e-3 * step for step in STEPS], (reader_name, times)
    for time, step in zip(times, STEPS):
        reader.UpdatePipeline(time)
        yield leaf(servermanager.Fetch(reader)), step
    simple.Delete(reader)


def check_points(reader_name, path):
    for data, step in steps_of(reader_name, path):
        assert data.GetNumberOfPoints() == COLUMNS * ROWS, (reader_name, data.GetNumberOfPoints())
        assert data.GetNumberOfCells() == COLUMNS * ROWS, (reader_name, data.GetNumberOfCells())
        assert data.GetFieldData().GetArray("pressure").GetTuple(0) == (100.0 + step,), reader_name
        assert vtk_to_numpy(data.GetPoints().GetData()).tolist() == expected("position", 3, step), reader_name
        for field, components in (("displacement", 3), ("damage", 1)):
            values = vtk_to_numpy(data.GetPointData().GetArray(field)).reshape(-1, components)
            assert values.tolist() == expected(field, components, step), (reader_name, field, step)


def check_lines(reader_name, path):
    for data, step in steps_of(reader_name, path):
        assert data.GetNumberOfPoints() == 2 * LINES, (reader_name, data.GetNumberOfPoints())
        assert data.GetNumberOfCells() == LINES, (reader_name, data.GetNumberOfCells())
        for line in range(LINES):
            ends = data.GetCell(line).GetPointIds()
            found = [ends.GetId(number) for number in range(ends.GetNumberOfIds())]
            assert found == [2 * line + line % 2, 2 * line + 1 - line % 2], (reader_name, line, found)
        assert data.GetFieldData().GetArray("inflow").GetTuple(0) == (100.0 + step,), reader_name
        assert data.GetFieldData().GetArray("vessels").GetTuple(0) == (34359738366.0,), reader_name
        positions = vtk_to_numpy(data.GetPoints().GetData())
        assert positions.tolist() == expected("position", 3, 0, 2 * LINES), reader_name
        for of, count, field, components in (
            (data.GetPointData(), 2 * LINES, "pressure", 1),
            (data.GetPointData(), 2 * LINES, "velocity", 3),
            (data.GetCellData(), LINES, "flow", 1),
            (data.GetCellData(), LINES, "direction", 3),
        ):
            values = vtk_to_numpy(of.GetArray(field)).reshape(-1, components)
            assert values.tolist() == expected(field, components, step, count), (reader_name, field, step)


READERS = [("XDMFReader", ".xdmf"), ("Xdmf3ReaderS", ".xdmf"), ("Xdmf3ReaderT", ".xdmf")]
if simple.GetParaViewVersion() >= (5, 12):
    READERS.append(("VTKHDFReader", ".vtkhdf"))

for program, check, file in ((sys.argv[1], check_points, "particles"), (sys.argv[2], check_lines, "network")):
    for precision in ("single", "double"):
        with tempfile.TemporaryDirectory(prefix="rhexis-test-") as folder:
            subprocess.run([program, folder, precision], check=True)
            for name, ending in READERS:
                check(name, os.path.join(folder, file + ending))
