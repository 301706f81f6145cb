# SPDX-License-Identifier: BSD-3-Clause
"""What is told of users' Catalyst scripts without running them (src/insitu/catalyst/inspection.py); needs no ParaView.

Arguments: SOURCE_DIRECTORY
"""

import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

SOURCE = Path(sys.argv.pop(1))
sys.path.insert(0, str(SOURCE / "src" / "insitu" / "catalyst"))
sys.dont_write_bytecode = True
import inspection  # noqa: E402

PARTICLES, NETWORK = ["displacement", "damage"], ["pressure", "flow", "radius"]
BOTH = {"particles": PARTICLES, "network": NETWORK}
READER = "reader = XDMFReader(registrationName='anything', FileNames=['/old/particles_from_000100.xdmf'])\n"
EXTRACTOR = "e{0} = CreateExtractor('PNG', view)\ne{0}.Writer.FileName = '{1}'\n"

# (script, wanted fields of the particles and of the network; None: not wanted)
GOOD = [
    ("", (PARTICLES, NETWORK)),
    ('fields = ["damage"]\n', (["damage"], None)),
    ('network_fields = ("flow",)\nfields = []\n', ([], ["flow"])),
    ('s = PVTrivialProducer(registrationName="network")\n', (None, NETWORK)),
    ('s = helper.GetTrivialProducer("particles.xdmf")\n', (PARTICLES, None)),
    (READER, (PARTICLES, None)),
    (READER + "reader.PointArrayStatus = ['damage']\n", (["damage"], None)),
    (READER + "reader.CellArrayStatus = ['damage']\n", (PARTICLES, None)),
    (READER + "reader.PointArrayStatus = ['damage']\nother = OpenDataFile('particles.xdmf')\n", (PARTICLES, None)),
    ("n = Xdmf3ReaderS(FileName=['a/network.xdmf'])\nn.PointArrays = ['pressure']\n", (None, NETWORK)),
    ("n = Xdmf3ReaderT(FileName=['a/network.xdmf'])\nn.PointArrays = ['pressure']\nn.CellArrays = ['flow']\n",
     (None, ["pressure", "flow"])),
    ("p = VTKHDFReader(registrationName='x', FileName=['a/particles.vtkhdf'])\n", (PARTICLES, None)),
    ("wall = STLReader(FileNames=['/home/me/wall.stl'])\nfields = []\n", ([], None)),
    ("saved_files = ['a/particles.xdmf']\nold = XDMFReader(FileNames=['a/particles.xdmf'])\nnetwork_fields = []\n", (None, [])),
    (EXTRACTOR.format(1, "a_{timestep}.png") + EXTRACTOR.format(2, "b_{timestep}.png"), (PARTICLES, NETWORK)),
]  # fmt: skip

# (script, what the message says)
BAD = [
    ("x = 1\nfor in x:\n", "line 2: SyntaxError: invalid syntax"),
    ("x = '\0'\n", "null byte"),
    ("fields = 5\n", 'line 1: fields must be a list of names, e.g. fields = ["damage"]'),
    ("fields = ['damge']\n", "line 1: asks for the field 'damge'; there are: displacement, damage; did you mean 'damage'?"),
    (READER + "reader.PointArrayStatus = ['Damage']\n", "line 2: asks for the field 'Damage'"),
    ("s = PVTrivialProducer(registrationName='particle')\n",
     "line 1: there is no channel 'particle'; there are: particles, network; did you mean 'particles'?"),
    ("r = vtkXdmfReader()\nr.SetFileName('a/particles.xdmf')\n",
     "line 2: 'a/particles.xdmf' holds saved results, which would be drawn in place of this run"),
    (READER + "\ne = CreateExtractor('VTU', reader)\n", "line 3: an extractor 'VTU' cannot write particles"),
    (EXTRACTOR.format(1, "../../a_{timestep}.png"), "line 2: FileName '../../a_{timestep}.png' lies outside"),
    (EXTRACTOR.format(1, "/home/me/a.png"), "e.g. 'a.png'"),
    (EXTRACTOR.format(1, "a_{timestep:06d}{camera}.png") + EXTRACTOR.format(2, "./a_{timestep:06d}.png"),
     "line 4: files named './a_{timestep:06d}.png' are also written by"),
]  # fmt: skip


class Inspection(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def script(self, text, name="script.py"):
        path = self.folder / name
        path.write_text(text)
        return str(path)

    def refusal(self, *scripts, channels=BOTH):
        with self.assertRaises(inspection.ScriptError) as caught:
            inspection.inspect([str(script) for script in scripts], channels)
        return str(caught.exception)

    def test_what_scripts_want(self):
        for text, expected in GOOD:
            with self.subTest(text):
                [wishes] = inspection.inspect([self.script(text)], BOTH)
                self.assertEqual([(name, fields) for name, fields in zip(BOTH, expected) if fields is not None], wishes)

    def test_missing_modules(self):
        with unittest.mock.patch("importlib.util.find_spec", lambda module: None if module == "paraview" else module):
            self.assertEqual(inspection.missing_modules(), "Python finds no module paraview (Debian: python3-paraview)")
        with unittest.mock.patch("importlib.util.find_spec", lambda module: module):
            self.assertEqual(inspection.missing_modules(), "")

    def test_what_is_wrong_with_scripts(self):
        for text, message in BAD:
            with self.subTest(text):
                script = self.script(text)
                refusal = self.refusal(script)
                self.assertIn(message, refusal)
                self.assertTrue(refusal.startswith(f"Catalyst script {script}"), refusal)

    def test_results_are_known_by_their_contents_too(self):
        copy = self.script('<Xdmf>\n<Domain>\n<Grid Name="network" GridType="Collection">', "renamed.xdmf")
        self.assertEqual(inspection.channel_of_file(copy), "network")
        other = self.script('<Xdmf>\n<Domain>\n<Grid Name="mesh">', "other.xdmf")
        self.assertIsNone(inspection.channel_of_file(other))
        self.assertIsNone(inspection.channel_of_file("/nowhere/mine.xdmf"))

    def test_two_scripts_with_one_name_of_pictures(self):
        first, second = (self.script(EXTRACTOR.format(1, "a_{timestep}.png"), name) for name in ("1.py", "2.py"))
        self.assertEqual(self.refusal(first, second), f"Catalyst script {second}, line 2: files named 'a_{{timestep}}.png' "
                                                      f"are also written by {first}, line 2; give one of them another name")  # fmt: skip
        self.assertIn("is named twice", self.refusal(first, first))

    def test_channels_that_the_run_has_not(self):
        network = SOURCE / "catalyst_scripts" / "network.py"
        self.assertEqual(self.refusal(network, channels={"particles": PARTICLES}),
                         f"Catalyst script {network}: asks for the channel 'network', which this run does not have; "
                         "there are: particles")  # fmt: skip

    def test_own_scripts_are_right(self):
        network = {"network": ["pressure", "flow", "radius", "kind"]}
        for name, channels in (("vessel", {"particles": PARTICLES}), ("network", network), ("template", {"particles": PARTICLES})):
            inspection.inspect([str(SOURCE / "catalyst_scripts" / f"{name}.py")], channels)

    def test_packages(self):
        package = self.folder / "package"
        package.mkdir()
        (package / "__init__.py").write_text('fields = ["damage"]\n')
        (package / "part.py").write_text("def f(:\n")
        self.assertIn(f"Catalyst script {package / 'part.py'}, line 1: SyntaxError", self.refusal(package))
        self.assertIn("No such file or directory", self.refusal(self.folder / "missing.py"))


if __name__ == "__main__":
    unittest.main()
