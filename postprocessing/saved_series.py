# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts have in common that draw saved series: arguments, moments in time, the loop over them."""

import argparse
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from paraview.simple import GetParaViewVersion, VTKHDFReader, XDMFReader

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "catalyst_scripts"))

from picture_tools import field_value


class Series:
    """A saved series: `frames`, (time in s, step) of each moment, and `data` of one of them."""

    def __init__(self, path, kind):
        self.path, self.is_xdmf = path, path.suffix != ".vtkhdf"
        if self.is_xdmf:
            try:
                self.frames = read_frames(path)
            except ElementTree.ParseError as error:
                sys.exit(f"error: {path} is not the {kind}.xdmf of a run ({error})")
            self.reader = XDMFReader(FileNames=[str(path)])
        else:
            version = GetParaViewVersion()
            if version < (5, 12):
                sys.exit(f"error: {path}: ParaView reads such files from 5.12 on, and this is {version.major}.{version.minor}; runs "
                         'write .xdmf with output.format = "xdmf" or "both"')
            self.reader = VTKHDFReader(FileName=[str(path)])
            self.reader.UpdatePipelineInformation()
            self.frames = [(time_s, int(field_value(self.data(time_s), "step"))) for time_s in self.reader.TimestepValues]

    def choose(self, point_fields, cell_fields):
        """Reads no other fields. Returns the names of those that the file lacks."""
        wanted = {*point_fields, *cell_fields}
        if self.is_xdmf:
            lacking = wanted - {*self.reader.PointArrayStatus.Available, *self.reader.CellArrayStatus.Available}
            if not lacking:
                self.reader.PointArrayStatus, self.reader.CellArrayStatus = point_fields, cell_fields
            return lacking
        self.reader.UpdatePipeline()
        return wanted - {*self.reader.PointData.keys(), *self.reader.CellData.keys()}

    def data(self, time_s):
        self.reader.UpdatePipeline(time_s)
        return self.reader.GetClientSideObject().GetOutputDataObject(0)


def read_frames(path):
    """(time in s, step) of each moment in an XDMF file."""
    frames = []
    for grid in ElementTree.parse(path).getroot().iter("Grid"):
        time, step = grid.find("Time"), grid.find("Information[@Name='step']")
        if time is not None and step is not None:
            frames.append((float(time.get("Value")), int(step.get("Value"))))
    return frames


def positive(text):
    number = int(text)
    if number < 1:
        raise ValueError(text)
    return number


def draw_series(description, kind, image_name, point_fields, cell_fields, draw):
    """Calls draw(image path, data, step, time in s) for each moment of the file named on the command line."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument(kind, type=Path, help=f"{kind}.xdmf or {kind}.vtkhdf of a run")
    parser.add_argument("-o", "--output", type=Path, help="folder of the images")
    parser.add_argument("--every", type=positive, default=1, metavar="N", help="only every Nth moment")
    arguments = parser.parse_args()
    path = getattr(arguments, kind)
    if not path.exists():
        sys.exit(f"error: no file {path}")
    output = arguments.output or path.parent / "images"
    series = Series(path, kind)
    if not series.frames:
        sys.exit(f"error: {path} holds no moment in time")
    absent = series.choose(point_fields, cell_fields)
    if absent:
        sys.exit(f"error: {path} holds no {' and no '.join(sorted(absent))}, which the picture of a {image_name} needs")
    output.mkdir(parents=True, exist_ok=True)
    for time_s, step in series.frames[:: arguments.every]:
        image = output / f"{image_name}_{step:06d}.png"
        draw(image, series.data(time_s), step, time_s)
        print(image)
