# SPDX-License-Identifier: BSD-3-Clause
"""Catalyst scripts as users name them: what check and run say of wrong ones, and that right ones change no results.

Arguments: RHEXIS MPIRUN...
"""

import os
import shutil
import subprocess
import unittest
import unittest.mock

import h5py
import numpy
from vessel_case import GOOD, RHEXIS, VesselCase, replaced

SHORT = replaced("end", 'end = "20 us"')
PICTURES = "Catalyst" in subprocess.run([RHEXIS, "--version"], capture_output=True, text=True, check=True).stdout
EXTRACTOR = "e = CreateExtractor('PNG', view)\ne.Writer.FileName = '{}'\n"

# (what, scripts, more keys of [insitu], what the message says)
WRONG = [
    ("syntax", ["def f(:\n"], "", ["a.py, line 1: SyntaxError"]),
    ("field", ['fields = ["damge"]\n'], "", ["a.py, line 1: asks for the field 'damge'", "did you mean 'damage'?"]),
    ("channel", ['network_fields = ["flow"]\n'], "", ["a.py: asks for the channel 'network'", "there are: particles"]),
    ("names", 2 * [EXTRACTOR.format("x_{timestep}.png")], "", ["b.py, line 2: files named 'x_{timestep}.png'", "a.py, line 2"]),
    ("outside", [EXTRACTOR.format("../x.png")], "", ["a.py, line 2: FileName '../x.png' lies outside"]),
    ("live", ["fields = []\n"], 'live = "localhost"\n', ["insitu.live", "host:port"]),
    ("limit", ["fields = []\n"], 'time_limit = "0 s"\n', ["insitu.time_limit"]),
]


class Scripts(VesselCase):
    def scene(self, scripts, more="", scene=SHORT):
        names = [f"{letter}.py" for letter, _ in zip("abc", scripts)]
        for name, text in zip(names, scripts):
            self.write(text, name)
        return self.write(scene + f"[insitu]\nscripts = {names}\n{more}".replace("'", '"'))

    def listing(self, folder):
        return {name: os.stat(os.path.join(folder, name)).st_mtime_ns for name in os.listdir(folder)}

    def test_own_scripts_are_known_by_name(self):
        self.write(SHORT + '[insitu]\nscripts = ["vesel"]\n')
        result = self.rhexis("check", "vessel.toml")
        self.assertEqual(result.returncode, 2)
        for text in ('vessel.toml:', 'insitu.scripts', '"coupled", "network", "stress", "template", "vessel"', "did you mean vessel?", '"./vesel.py"'):
            self.assertIn(text, result.stderr)
        os.mkdir(self.path("vessel"))  # no script: what is meant is Rhexis's own
        result = self.rhexis("check", "vessel.toml", "--set", 'insitu.scripts=["vessel"]')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.write("def f(:\n", "vessel/__init__.py")  # a package of the user's
        result = self.rhexis("check", "vessel.toml", "--set", 'insitu.scripts=["vessel"]')
        self.assertEqual(result.returncode, 2 if PICTURES else 0, result.stderr)

    @unittest.skipUnless(PICTURES, "built without ParaView")
    def test_an_installed_program_has_its_scripts_beside_it(self):
        build = os.path.dirname(os.path.dirname(RHEXIS))
        scripts = self.path("share/rhexis/catalyst_scripts")
        os.makedirs(scripts)
        os.mkdir(self.path("bin"))
        os.symlink(os.path.join(build, "lib"), self.path("lib"))
        program = shutil.copy2(RHEXIS, self.path("bin"))
        self.write("def f(:\n", "share/rhexis/catalyst_scripts/vessel.py")
        self.write(SHORT + '[insitu]\nscripts = ["vessel"]\n')
        result = subprocess.run([program, "check", "vessel.toml"], cwd=self.folder.name, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn(f"{os.path.realpath(scripts)}/vessel.py, line 1: SyntaxError", result.stderr)

    @unittest.skipUnless(PICTURES, "built without ParaView")
    def test_wrong_scripts_are_told_before_anything_is_written(self):
        self.write(SHORT)
        self.assertEqual(self.rhexis("run", "vessel.toml", "-o", "out").returncode, 0)
        before = self.listing(self.path("out"))
        for number, (what, scripts, more, messages) in enumerate(WRONG):
            with self.subTest(what):
                self.scene(scripts, more)
                for command in (["check", "vessel.toml"], ["run", "vessel.toml", "-o", "out"]):
                    result = self.rhexis(*command, ranks=2 if number == 0 else None)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    for message in messages:
                        self.assertEqual(result.stderr.count(message), 1, result.stderr)
                    self.assertEqual(self.listing(self.path("out")), before)

    @unittest.skipUnless(PICTURES, "built without ParaView")
    def test_scripts_do_not_change_results(self):
        mutate = (
            "from paraview.simple import *\nparticles = PVTrivialProducer(registrationName='particles')\n"
            "from vtkmodules.util.numpy_support import vtk_to_numpy\n"
            "def catalyst_execute(info):\n"
            "    data = particles.GetClientSideObject().GetOutputDataObject(0)\n"
            "    arrays = [data.GetPointData().GetArray(i) for i in range(data.GetPointData().GetNumberOfArrays())]\n"
            "    assert len(arrays) == 5\n"
            "    for array in [*arrays, data.GetPoints().GetData()]: vtk_to_numpy(array)[:] = 7\n"
            "    data.GetPointData().Initialize()\n")  # fmt: skip
        self.scene([mutate], 'live = "localhost:9"\n', GOOD)  # the port of "discard", where nobody listens
        for folder, more in (("plain", ["--set", "insitu.enabled=false"]), ("drawn", ["--set", "output.movie=false"])):
            result = self.rhexis("run", "vessel.toml", "-o", folder, *more)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(self.history("plain"), self.history("drawn"))
        with h5py.File(self.path("plain/particles.h5")) as plain, h5py.File(self.path("drawn/particles.h5")) as drawn:
            names = []
            plain.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
            self.assertGreater(len(names), 10)
            for name in names:
                self.assertTrue(numpy.array_equal(plain[name][()], drawn[name][()]), name)

    @unittest.skipUnless(PICTURES, "built without ParaView")
    def test_a_script_that_hangs_is_recorded(self):
        self.scene(["fields = []\nimport time\ndef catalyst_execute(info):\n  while True:\n    try: time.sleep(1000)\n    except: pass\n"],
                   'time_limit = "1 s"\n')  # fmt: skip
        with unittest.mock.patch.dict(os.environ, RHEXIS_SCRIPT_TIMEOUT="1"):
            result = self.rhexis("run", "vessel.toml", "-o", "out")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("a.py: not done after 1 s (insitu.time_limit)", result.stderr)
        status = self.record("out")["status"]
        self.assertTrue(status.startswith("failed: Catalyst script ") and "not done after 1 s" in status, status)


if __name__ == "__main__":
    unittest.main(argv=["test_pictures.py"])
