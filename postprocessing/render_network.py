# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a saved network: the same as catalyst_scripts/network.py makes during the run.

    postprocessing/pvpython_headless postprocessing/render_network.py results/.../network.xdmf
    ... [-o DIRECTORY] [--every N]

Images network_<step>.png go to DIRECTORY (default: images/ beside the file).
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from saved_series import draw_series

from network_picture import NetworkPicture

picture = NetworkPicture()


def draw(image, network, step, time_s):
    picture.save(image, network, time_s)


draw_series(__doc__.splitlines()[0], "network", "network", ["pressure"], ["flow", "radius", "kind"], draw)
