# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of pictures have in common: the program insitu_driver, and pictures as numbers.

Arguments of a test: DRIVER PLUGIN_DIRECTORY SOURCE_DIRECTORY MPIRUN... [-- unittest arguments]
No display is needed: DISPLAY is removed. Colours are compared in steps of 1/255.
"""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy
from matplotlib import image

arguments = sys.argv[1 : sys.argv.index("--")] if "--" in sys.argv else sys.argv[1:]
DRIVER, PLUGINS, SOURCE, MPIRUN = arguments[0], arguments[1], Path(arguments[2]), arguments[3:]
VESSEL = SOURCE / "catalyst_scripts" / "vessel.py"
NETWORK = SOURCE / "catalyst_scripts" / "network.py"
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "DISPLAY"} | {
    "RHEXIS_PLUGIN_DIR": PLUGINS,
    "RHEXIS_SCRIPT_TIMEOUT": "2",
    "OMP_NUM_THREADS": "2",
}
BUILT = (Path(PLUGINS) / "librhexis_catalyst.so").exists()


def read(path):
    """An image as whole numbers 0 ... 255, rows x columns x RGB."""
    return numpy.rint(255 * image.imread(path)[..., :3]).astype(int)


def like(picture, colour, tolerance=12):
    return (numpy.abs(picture - colour) <= tolerance).all(axis=-1)


def complaints(stderr):
    """What a program said on stderr, but for the MPI library's remarks on containers without /sys."""
    return "".join(line for line in stderr.splitlines(keepends=True) if not line.startswith("[hwloc/linux]"))


class DriverTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.images = self.folder / "images"

    def script(self, text, name="script.py"):
        path = self.folder / name
        path.write_text(text)
        return path

    def run_driver(self, *scripts, frames=2, ranks=1, renderer="automatic", status=0, channels="particles"):
        """Output lines of a run; errors of VTK or Python on stderr fail the test."""
        command = [*MPIRUN, "-n", str(ranks)] if ranks > 1 else []
        command += [DRIVER, str(self.images), renderer, channels, str(frames), *map(str, scripts)]
        result = subprocess.run(command, env=ENVIRONMENT, cwd=self.folder, capture_output=True, text=True, timeout=50)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        errors = complaints(result.stderr)
        if status == 0:
            self.assertEqual(errors, "")
        self.errors = errors
        return result.stdout.splitlines()

    def failure(self, *scripts, ranks=1, frames=2, channels="particles"):
        """The one message that every rank gives when a script fails."""
        messages = [line for line in self.run_driver(*scripts, ranks=ranks, frames=frames, status=3, channels=channels) if "error:" in line]
        self.assertEqual(len(messages), ranks)
        self.assertEqual(len(set(messages)), 1)
        self.assertNotIn("Traceback", self.errors)
        return messages[0].removeprefix("error: ")


def main():
    rest = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    unittest.main(argv=[sys.argv[0], *rest])
