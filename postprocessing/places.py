# SPDX-License-Identifier: BSD-3-Clause
"""Where a study finds its inputs, the program and `import rhexis`, and where it writes: in a clone, or in the installation that
this file is in."""

import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent  # with inputs/: the clone, or share/rhexis of an installation
IS_CLONE = (ROOT / "CMakeLists.txt").exists()
PROGRAM = ROOT / "build/release/bin/rhexis" if IS_CLONE else ROOT.parent.parent / "bin/rhexis"
RESULTS = ROOT / "results" if IS_CLONE else pathlib.Path("results")
sys.path.append(str(PROGRAM.parent.parent / "lib/python3/dist-packages"))
