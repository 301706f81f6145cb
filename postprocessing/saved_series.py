"""What the scripts have in common that draw saved series: arguments, moments in time, the loop over them."""

import argparse
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from paraview.simple import XDMFReader

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "catalyst_scripts"))


def read_frames(path):
    """(time in s, step) of each moment in the file."""
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
    parser.add_argument(kind, type=Path, help=f"{kind}.xdmf of a run")
    parser.add_argument("-o", "--output", type=Path, help="folder of the images")
    parser.add_argument("--every", type=positive, default=1, metavar="N", help="only every Nth moment")
    arguments = parser.parse_args()
    path = getattr(arguments, kind)
    if not path.exists():
        sys.exit(f"error: no file {path}")
    output = arguments.output or path.parent / "images"
    try:
        frames = read_frames(path)
    except ElementTree.ParseError as error:
        sys.exit(f"error: {path} is not the {kind}.xdmf of a run ({error})")
    if not frames:
        sys.exit(f"error: {path} holds no moment in time")
    reader = XDMFReader(FileNames=[str(path)])
    absent = {*point_fields, *cell_fields} - {*reader.PointArrayStatus.Available, *reader.CellArrayStatus.Available}
    if absent:
        sys.exit(f"error: {path} holds no {' and no '.join(sorted(absent))}, which the picture of a {image_name} needs")
    output.mkdir(parents=True, exist_ok=True)
    reader.PointArrayStatus, reader.CellArrayStatus = point_fields, cell_fields
    for time_s, step in frames[:: arguments.every]:
        reader.UpdatePipeline(time_s)
        image = output / f"{image_name}_{step:06d}.png"
        draw(image, reader.GetClientSideObject().GetOutputDataObject(0), step, time_s)
        print(image)
