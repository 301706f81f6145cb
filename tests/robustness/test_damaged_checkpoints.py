# SPDX-License-Identifier: BSD-3-Clause
"""Restarts from damaged checkpoints: refused with one line that names the file, or, where the damage hit nothing that is used,
bit-identical to those from the undamaged one. robustness_study.py tries more, and more scenes.

Run by ctest as: test_damaged_checkpoints.py RHEXIS [NUMBER [SEED]]
"""

import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py

from study.damage import KINDS, datasets
from study.tube import SMALL_TUBE

RHEXIS = sys.argv[1]
NUMBER = int(sys.argv[2]) if len(sys.argv) > 2 else 40
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 1

TUBE = SMALL_TUBE + """\
[time]
step = "1 us"
end = "60 us"
[output]
every_steps = 5
"""


def take_from_other(rng, path, other):
    """A data set of the same run at another step: whole, and with its own attributes."""
    with h5py.File(path, "r+") as file, h5py.File(other) as source:
        name = rng.choice([name for name in datasets(file) if name not in ("input", "measures")])
        del file[name]
        source.copy(name, file)


class DamagedCheckpoints(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rhexis_damaged_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "tube.toml").write_text(TUBE)

    def run_tube(self, folder, *more):
        return subprocess.run([RHEXIS, "run", "tube.toml", "--quiet", "-o", folder, *more], cwd=self.folder, capture_output=True, text=True,
                              errors="replace", timeout=60, stdin=subprocess.DEVNULL, env={**os.environ, "OMP_NUM_THREADS": "1"}, check=False)

    def results(self, folder):
        """What a run found, without what differs between two runs of the same."""
        return [(self.folder / folder / name).read_bytes() for name in ("history.csv", "particles_from_000040.h5")]

    def test_damage_is_refused_or_harmless(self):
        self.assertEqual(self.run_tube("whole", "--set", "output.checkpoint_every=20").returncode, 0)
        good, other = (self.folder / f"whole/checkpoints/step_0000{step}.h5" for step in (40, 20))
        self.assertEqual(self.run_tube("good", "--restart", str(good)).returncode, 0)
        expected = self.results("good")
        harmless = 0
        for number in range(NUMBER):
            rng = random.Random(SEED * 1_000_003 + number)
            bad = self.folder / "bad.h5"
            shutil.copy(good, bad)
            kind = rng.choice([*KINDS, lambda rng, path: take_from_other(rng, path, other)])
            kind(rng, bad)
            with self.subTest(number=number, kind=kind.__name__):
                done = self.run_tube("out", "--restart", "bad.h5")
                if done.returncode == 0:
                    harmless += 1
                    self.assertEqual(self.results("out"), expected)
                else:
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertRegex(done.stderr, r"\Arhexis: bad\.h5: [^\n]+\n\Z")
                    self.assertFalse((self.folder / "out").exists())
                shutil.rmtree(self.folder / "out", ignore_errors=True)
        print(f"{NUMBER} damaged checkpoints: {harmless} harmless, the others refused")
        self.assertLess(harmless, 0.6 * NUMBER)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
