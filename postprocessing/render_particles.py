# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a vessel from saved particles: the same as catalyst_scripts/vessel.py makes during the run.

    postprocessing/pvpython_headless postprocessing/render_particles.py results/perivessel/particles.xdmf
    ... [-o DIRECTORY] [--every N]

Images vessel_<step>.png go to DIRECTORY (default: images/ beside the file).
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from saved_series import draw_series

from picture_tools import field_value
from vessel_picture import VesselPicture

picture = None


def draw(image, particles, step, time_s):
    global picture
    picture = picture or VesselPicture(particles)
    picture.save(image, particles, step, time_s, field_value(particles, "pressure"))


draw_series(__doc__.splitlines()[0], "particles", "vessel", ["displacement", "damage"], [], draw)
