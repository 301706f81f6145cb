"""What people have met: each fault's case as a row, with how the run must end, what it must say, and that it leaves files alone.

Run by ctest as: test_fault_table.py RHEXIS   (with /usr/bin/python3, which has h5py)
"""

import dataclasses
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from coupled_case import at_once  # noqa: E402
from study.program import changes, snapshot  # noqa: E402

RHEXIS = str(pathlib.Path(sys.argv[1]).resolve())

# 88 columns x 14 rows, 20 steps: a tenth of a second.
VESSEL = """\
[vessel]
inner_radius = "1.5 mm"
outer_radius = "2 mm"
length = "3.5 mm"
[discretisation]
spacing = "250 um"
horizon_ratio = 2.2
[load]
pressure = "200 kPa"
ramp_time = "0.1 ms"
[time]
step = "2 us"
end = "40 us"
[output]
every_steps = 10
checkpoint_every = 10
movie = false
"""


@dataclasses.dataclass
class Fault:
    name: str
    status: int
    said: list  # phrases of the one error message
    files: dict = dataclasses.field(default_factory=dict)  # beside s.toml: name -> text or bytes; "-> target" for a link
    scene: str = VESSEL
    command: list = dataclasses.field(default_factory=lambda: ["run", "s.toml", "-o", "out", "--quiet"])
    environment: dict = dataclasses.field(default_factory=dict)


INPUTS = [
    Fault("a key that begins with an accent", 2, ["s.toml:5", "'é'"], scene=VESSEL.replace("[discretisation]", "élength = 1\n[discretisation]")),
]


class FaultTable(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rhexis_faults_")
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)

    def prepare(self, fault, number):
        folder = self.path / str(number)
        for name, content in {"s.toml": fault.scene, **fault.files}.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            if isinstance(content, str) and content.startswith("-> "):
                path.symlink_to(content[3:])
            else:
                path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return folder

    def rhexis(self, folder, arguments, **environment):
        """Within 4 GB and 20 s of a processor."""
        with tempfile.TemporaryDirectory() as sessions:
            environment = {**os.environ, "OMPI_MCA_orte_tmpdir_base": sessions, **environment}
            return subprocess.run(["sh", "-c", 'ulimit -v 4000000; ulimit -t 20; exec "$@"', "limits", RHEXIS, *arguments], cwd=folder,
                                  capture_output=True,
                                  text=True, timeout=300, stdin=subprocess.DEVNULL, env=environment, check=False)

    def check_all(self, faults):
        """Runs all; after status 2 every file is as it was, after others those of the user are."""
        folders = [self.prepare(fault, number) for number, fault in enumerate(faults)]
        before = [snapshot(folder) for folder in folders]
        results = at_once(lambda fault, folder: self.rhexis(folder, fault.command, **fault.environment), list(zip(faults, folders)))
        for fault, folder, files, result in zip(faults, folders, before, results):
            with self.subTest(fault.name):
                self.assertEqual(result.returncode, fault.status, result.stderr)
                messages = [line for line in result.stderr.splitlines() if line.startswith("rhexis: ") and not line.startswith("rhexis: warning: ")]
                self.assertEqual(len(messages), 0 if fault.status == 0 else 1, result.stderr)
                for phrase in fault.said:
                    self.assertIn(phrase, result.stderr)
                after = snapshot(folder)
                if fault.status != 2:
                    after = {name: after.get(name) for name in files}
                self.assertEqual(changes(files, after), [])

    def test_inputs(self):
        self.check_all(INPUTS)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
