"""ParaView's three XDMF readers read a series of write_sample_series (argv[1]): steps, cells, values."""

import os
import subprocess
import sys
import tempfile

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

COLUMNS, ROWS = 5, 7
STEPS = [0, 50, 73]


def expected(field, components, step):
    """As expected_value in synthetic_source.hpp."""
    values = []
    for point in range(COLUMNS * ROWS):
        base = len(field) * 4096 + point + 0.25 * (step % 4)
        values.append([base + 1024 * c for c in range(components)])
    return values


def leaf(data):
    """The first data set of a composite one."""
    while data.IsA("vtkMultiBlockDataSet"):
        data = data.GetBlock(0)
    return data


def check(reader_name, path):
    reader = getattr(simple, reader_name)()
    reader.SetPropertyWithName("FileNames" if reader_name == "XDMFReader" else "FileName", [path])
    reader.UpdatePipelineInformation()
    times = list(reader.TimestepValues)
    assert times == [1e-3 * step for step in STEPS], (reader_name, times)
    for time, step in zip(times, STEPS):
        reader.UpdatePipeline(time)
        data = leaf(servermanager.Fetch(reader))
        assert data.GetNumberOfPoints() == COLUMNS * ROWS, (reader_name, data.GetNumberOfPoints())
        assert data.GetNumberOfCells() == COLUMNS * ROWS, (reader_name, data.GetNumberOfCells())
        assert data.GetFieldData().GetArray("pressure").GetTuple(0) == (100.0 + step,), reader_name
        assert vtk_to_numpy(data.GetPoints().GetData()).tolist() == expected("position", 3, step), reader_name
        for field, components in (("displacement", 3), ("damage", 1)):
            values = vtk_to_numpy(data.GetPointData().GetArray(field)).reshape(-1, components)
            assert values.tolist() == expected(field, components, step), (reader_name, field, step)
    simple.Delete(reader)


for precision in ("single", "double"):
    with tempfile.TemporaryDirectory(prefix="rhexis-test-") as folder:
        subprocess.run([sys.argv[1], folder, precision], check=True)
        for name in ("XDMFReader", "Xdmf3ReaderS", "Xdmf3ReaderT"):
            check(name, os.path.join(folder, "particles.xdmf"))
