# SPDX-License-Identifier: BSD-3-Clause
"""An installation, moved after it was made: the program runs and draws, and the examples build against its libraries.

Run by ctest as: test_install.py BUILD_DIR SOURCE_DIR CMAKE
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BUILD, SOURCE, CMAKE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
SHORT = ["--set", "vessel.length=1.2 mm", "--set", "time.end=4 us", "--set", "output.every_steps=2"]
LEVELS = sorted(BUILD.glob("lib*/**/glibc-hwcaps/*"))


def run(*command, **options):
    result = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False, **options)
    if result.returncode != 0:
        raise AssertionError(f"{command}:\n{result.stdout}\n{result.stderr}")
    return result.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name).resolve()
        run(CMAKE, "--install", BUILD, "--prefix", cls.root / "first")
        os.rename(cls.root / "first", cls.root / "moved")
        cls.prefix = cls.root / "moved"
        cls.program = cls.prefix / "bin/rhexis"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_vessel_runs_with_pictures(self):
        inputs = self.prefix / "share/rhexis/inputs"
        run(self.program, "run", inputs / "perivessel.toml", "-o", self.root / "results", "--quiet", *SHORT, cwd=self.root)
        record = json.loads((self.root / "results/run.json").read_text())
        self.assertEqual(record["status"], "completed")
        if "Catalyst" in run(self.program, "--version"):
            self.assertTrue(list((self.root / "results/images").glob("*.png")))
            render = self.prefix / "share/rhexis/postprocessing"
            run(render / "pvpython_headless", render / "render_particles.py", self.root / "results/particles.xdmf", "-o", self.root / "after")
            self.assertTrue(list((self.root / "after").glob("*.png")))

    @unittest.skipUnless(LEVELS, "built for this machine's processor only")
    def test_each_level_of_processors_gives_the_same_results(self):
        inputs = self.prefix / "share/rhexis/inputs"
        peaks, levels = {}, self.prefix / LEVELS[0].parent.relative_to(BUILD)
        supported = run("/lib64/ld-linux-x86-64.so.2", "--help")
        # The best comes first; then it is moved away, and the next is the best.
        for level in ["x86-64-v4", "x86-64-v3", "x86-64-v2"]:
            if level != "x86-64-v2" and f"{level} (supported" not in supported:
                continue
            loaded = re.search(r"librhexis_peridynamics\S* => (\S+)", run("ldd", self.program)).group(1)
            self.assertEqual(f"/glibc-hwcaps/{level}/" in loaded, level != "x86-64-v2", loaded)
            folder = self.root / level
            run(self.program, "run", inputs / "perivessel.toml", "-o", folder, "--quiet", *SHORT, "--set", "insitu.enabled=false")
            peaks[level] = json.loads((folder / "run.json").read_text())["results"]["max_displacement_m"]
            if level != "x86-64-v2":
                os.rename(levels / level, self.root / f"away-{level}")
        for level in peaks:
            if (self.root / f"away-{level}").exists():
                os.rename(self.root / f"away-{level}", levels / level)
            # Single precision inside a bond: levels round differently.
            self.assertAlmostEqual(peaks[level] / peaks["x86-64-v2"], 1, delta=1e-5)

    @unittest.skipUnless(list(BUILD.glob("lib/python3/dist-packages/rhexis/_rhexis*")), "built without pybind11")
    def test_python_imports_it(self):
        ask = "import rhexis, sys; print(rhexis.__file__); print(rhexis.run(sys.argv[1], {'time.end': '1 us'})['steps'])"
        folder = self.prefix / "lib/python3/dist-packages"
        file, steps = run(sys.executable, "-c", ask, self.prefix / "share/rhexis/inputs/vented_vessel.toml",
                          env=os.environ | {"PYTHONPATH": str(folder)}).splitlines()
        self.assertTrue(file.startswith(str(folder)), file)
        self.assertGreater(int(steps), 0)

    def test_an_example_builds_against_the_libraries(self):
        build = self.root / "build"
        run(CMAKE, "-S", SOURCE / "examples/fork", "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release")
        run(CMAKE, "--build", build)
        flows = [float(line.split()[2]) for line in run(build / "fork").splitlines()]
        self.assertEqual(len(flows), 3)
        self.assertAlmostEqual(flows[0], flows[1] + flows[2], delta=2e-3 * flows[0])
        # Poiseuille's law: equal lengths and pressures, so flows are as the fourth powers of the radii.
        self.assertAlmostEqual(flows[1] / flows[2], (1.6 / 1.2) ** 4, delta=2e-3 * flows[1] / flows[2])

    def test_nothing_names_the_folder_it_was_built_in(self):
        for file in self.prefix.rglob("*.cmake"):
            self.assertNotIn(str(SOURCE), file.read_text(), str(file))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
