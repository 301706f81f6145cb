"""Pictures of a vessel from saved particles: the same as catalyst_scripts/vessel.py makes during the run.

    postprocessing/pvpython_headless postprocessing/render_particles.py results/perivessel/particles.xdmf
    ... [-o DIRECTORY] [--every N]

Images vessel_<step>.png go to DIRECTORY (default: images/ beside the file).
"""

import argparse
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from paraview.simple import XDMFReader

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "catalyst_scripts"))

from picture_tools import field_value
from vessel_picture import VesselPicture


def read_frames(path):
    """(time in s, step) of each moment in the file; the step is in the names of the data sets."""
    frames = []
    for grid in ElementTree.parse(path).getroot().iter("Grid"):
        time = grid.find("Time")
        if time is None:
            continue
        data_sets = " ".join(item.text for item in grid.iter("DataItem") if item.text)
        step = re.search(r":/position/(\d+)", data_sets)
        frames.append((float(time.get("Value")), int(step.group(1)) if step else len(frames)))
    return frames


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("particles", type=Path, help="particles.xdmf of a run")
    parser.add_argument("-o", "--output", type=Path, help="folder of the images")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="only every Nth moment")
    arguments = parser.parse_args()
    if not arguments.particles.exists():
        sys.exit(f"error: no file {arguments.particles}")
    output = arguments.output or arguments.particles.parent / "images"
    output.mkdir(parents=True, exist_ok=True)

    frames = read_frames(arguments.particles)
    if not frames:
        sys.exit(f"error: {arguments.particles} holds no moment in time")
    reader = XDMFReader(FileNames=[str(arguments.particles)])
    reader.PointArrayStatus = ["displacement", "damage"]
    picture = None
    for time_s, step in frames[:: arguments.every]:
        reader.UpdatePipeline(time_s)
        particles = reader.GetClientSideObject().GetOutputDataObject(0)
        picture = picture or VesselPicture(particles)
        image = output / f"vessel_{step:06d}.png"
        picture.save(image, particles, step, time_s, field_value(particles, "pressure"))
        print(image)


main()
