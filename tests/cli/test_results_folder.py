# SPDX-License-Identifier: BSD-3-Clause
"""A run loses nothing of the user's: what it replaces, removes, follows and leaves in its folder of results."""

import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.dirname(__file__))
from vessel_case import GOOD, RHEXIS, VesselCase  # noqa: E402

PICTURES = "Catalyst" in subprocess.run([RHEXIS, "--version"], capture_output=True, text=True, check=True).stdout

# 1152 particles, 10 steps.
TINY = GOOD.replace('length = "2 mm"', 'length = "3 mm"').replace('"100 um"', '"250 um"').replace('end = "50 us"', 'end = "5 us"') + "checkpoint_every = 5\n"
NETWORK = """\
[scene]
model = "network"

[network]
source = "file"
files = ["junctions.csv", "vessels.csv"]
"""
JUNCTIONS = "id,x [mm],y [mm],z [mm],pressure [mmHg]\nin,0,0,0,100\nout,10,0,0,90\n"
VESSELS = "id,from,to,radius [mm]\n1,in,out,1\n"
RESULTS = {"manifest.txt", "run.json", "history.csv", "particles.h5", "particles.xdmf", "checkpoints/step_000005.h5",
           "checkpoints/step_000010.h5"}


class ResultsFolder(VesselCase):
    def setUp(self):
        super().setUp()
        self.root = pathlib.Path(self.folder.name)
        self.write(TINY)
        self.results = self.root / "r"

    def put(self, *names, text="mine"):
        for name in names:
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")

    def contents(self, folder="."):
        """What every file and link below a folder holds."""
        return {str(path.relative_to(self.root / folder)): os.readlink(path) if path.is_symlink() else path.read_bytes()
                for path in (self.root / folder).rglob("*") if path.is_symlink() or path.is_file()}

    def run_into(self, *more, ranks=None, file="vessel.toml"):
        return self.rhexis("run", file, "-o", "r", "--quiet", *more, ranks=ranks)

    def run_well(self, *more, ranks=None, file="vessel.toml"):
        result = self.run_into(*more, ranks=ranks, file=file)
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def assert_refused(self, fragments, *more, ranks=None, file="vessel.toml"):
        """By run and, where it can tell, by check, in one message; and nothing changes."""
        before = self.contents()
        result = self.run_into(*more, ranks=ranks, file=file)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("rhexis: "), 1, result.stderr)
        for fragment in fragments:
            self.assertIn(fragment, result.stderr)
        self.assertEqual(self.contents(), before)
        if not more:
            checked = self.rhexis("check", file, "-o", "r")
            self.assertEqual(checked.returncode, 2)
            self.assertTrue(result.stderr.startswith(checked.stderr), result.stderr)  # mpirun adds its own words
            self.assertEqual(self.contents(), before)

    # -- what a run leaves alone --------------------------------------------------------------------------------

    def test_files_of_others_stay(self):
        names = ["event_2024/history.csv", "event_2024/images/party_12.png", "event_01/mine", "images/IMG_20240101.png",
                 "images/holiday_001.png", "images/other.png", "movie.mp4", "network.vtp", "coupling.csv", "vessels.csv",
                 "notes.txt", "run.json.part", "particles_from_000100.h5", "checkpoints/mine.h5", "checkpoints/step_5.h5"]
        self.put(*(f"r/{name}" for name in names))
        for ranks in (None, 2):
            self.run_well(ranks=ranks)
            contents = self.contents("r")
            self.assertEqual({name: contents.pop(name) for name in names}, dict.fromkeys(names, b"mine"))
            self.assertEqual(contents.keys(), RESULTS)

    def test_results_of_an_earlier_run_go_but_for_its_checkpoints(self):
        self.run_well()
        self.run_well("--set", "output.fields=[]", "--set", "output.checkpoint_every=0")
        self.assertEqual(self.contents("r").keys(), RESULTS - {"particles.h5", "particles.xdmf"})
        self.run_well("--restart", "r/checkpoints/step_000005.h5")
        self.assertEqual(self.contents("r").keys(),
                         RESULTS - {"particles.h5", "particles.xdmf"} | {f"particles_from_000005.{e}" for e in ("h5", "xdmf")})
        self.run_well()
        self.assertEqual(self.contents("r").keys(), RESULTS)

    def test_a_file_in_the_way_is_refused_unless_it_may_be_overwritten(self):
        for name in sorted(RESULTS - {"manifest.txt"}):
            with self.subTest(name):
                self.put(f"r/{name}")
                self.assert_refused([f"cannot write results to r: {name} would be replaced", "--overwrite", "-o"],
                                    ranks=2 if name == "run.json" else None)
                self.run_well("--overwrite")
                self.assertNotEqual((self.results / name).read_bytes(), b"mine")
                self.run_well()
                os.rename(self.results, self.root / f"after {len(os.listdir(self.root))}")

    def test_a_damaged_manifest_is_refused(self):
        self.run_well()
        for text, reason in (("mine", "its first line should be"), ("rhexis results 1\nfile ../vessel.toml\n", "manifest.txt:2")):
            self.put("r/manifest.txt", text=text)
            self.assert_refused(["r/manifest.txt", reason, "--overwrite", "-o"])
        self.run_well("--overwrite")

    # -- what it reads ------------------------------------------------------------------------------------------

    def test_files_that_the_run_reads_are_never_replaced(self):
        self.put("r/net.toml", text=NETWORK)
        self.put("r/junctions.csv", text=JUNCTIONS)
        self.put("r/vessels.csv", text=VESSELS)
        for ranks in (None, 2):
            self.assert_refused(["the run reads vessels.csv and would replace it"], ranks=ranks, file="r/net.toml")
            self.assert_refused(["the run reads vessels.csv"], "--overwrite", ranks=ranks, file="r/net.toml")
        # Nor through a link, nor as results of an earlier run.
        os.rename(self.results, self.root / "input")
        self.run_well(file="input/net.toml")
        self.put("input/again.toml", text=NETWORK.replace('"vessels.csv"', '"link.csv"'))
        os.symlink("../input/vessels.csv", self.results / "mine.csv")
        os.symlink("vessels.csv", self.root / "input/link.csv")
        os.link(self.root / "input/vessels.csv", self.root / "hard.csv")
        os.replace(self.root / "hard.csv", self.results / "vessels.csv")
        self.assert_refused(["the run reads vessels.csv"], file="input/again.toml")

    def test_a_checkpoint_never_replaces_the_one_that_was_restarted_from(self):
        self.run_well()
        os.rename(self.results / "checkpoints/step_000005.h5", self.results / "checkpoints/step_000008.h5")
        self.assert_refused(["reads checkpoints/step_000008.h5"], "--restart", "r/checkpoints/step_000008.h5", "--overwrite")

    # -- pictures -----------------------------------------------------------------------------------------------

    def run_scripts(self, *scripts, more=(), ranks=None):
        names = []
        for text in scripts:
            names.append(f"script{len(names)}.py")
            self.put(names[-1], text="fields = []\ndef catalyst_execute(info):\n    " + text)
        return self.run_into("--set", f"insitu.scripts={names}", *more, ranks=ranks)

    @unittest.skipUnless(PICTURES, "built without ParaView")
    def test_pictures_of_the_user_and_of_other_scripts_are_not_replaced(self):
        picture = "open(f'{image_directory}/a_{info.timestep}.png', 'w').write('ours')\n"
        for ranks in (None, 2):
            self.put("r/images/a_10.png")
            result = self.run_scripts(picture, ranks=ranks)
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertRegex(result.stderr, "script0.py: cannot write results to r: images/a_10.png would be replaced")
            self.assertEqual(self.contents("r/images"), {"a_0.png": b"ours", "a_10.png": b"mine"})
            self.assertIn("images/a_10.png", self.record("r")["status"])
            os.remove(self.results / "images/a_10.png")
            result = self.run_scripts(picture, picture.replace("ours", "other"), ranks=ranks)
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertRegex(result.stderr, "script0.py and Catalyst script .*script1.py both write images/a_0.png at step 0")

    @unittest.skipUnless(PICTURES, "built without ParaView")
    def test_scripts_go_on_with_their_own_files(self):
        table = ("import os\n    open(f'{image_directory}/deeper.csv', 'a').write(f'{info.timestep}\\n')\n"
                 "    if info.timestep == 10: open(f'{image_directory}/a_1.png', 'w').write(open(f'{image_directory}/a_0.png').read())\n"
                 "    else: open(f'{image_directory}/a_{info.timestep}.png', 'w').write('ours')\n")
        more = ("--set", "output.every_steps=5")
        self.assertEqual(self.run_scripts(table, more=more).returncode, 0)
        expected = {"deeper.csv": b"0\n5\n10\n", **dict.fromkeys(["a_0.png", "a_5.png", "a_1.png"], b"ours")}
        self.assertEqual(self.contents("r/images"), expected)
        self.assertEqual(sorted(os.listdir(self.results / "images")), sorted(expected))
        result = self.run_scripts(table, more=(*more, "--restart", "r/checkpoints/step_000005.h5"), ranks=2)
        self.assertEqual(result.returncode, 0, result.stderr)
        # Every rank runs the script.
        self.assertEqual(self.contents("r/images"), {**expected, "deeper.csv": b"0\n5\n10\n5\n5\n10\n10\n"})

    # -- links --------------------------------------------------------------------------------------------------

    def test_links_are_not_followed(self):
        files = ["history.csv", "run.json", "particles.h5", "particles.xdmf", "checkpoints/step_000005.h5", "manifest.txt"]
        for ranks in (None, 2):
            for name in files if ranks is None else files[:1]:
                with self.subTest(name):
                    self.put("victim", text="secret")
                    self.results.mkdir()
                    (self.results / name).parent.mkdir(exist_ok=True)
                    os.symlink(self.root / "victim", self.results / name)
                    self.assert_refused([name], ranks=ranks)
                    self.run_well("--overwrite", ranks=ranks)
                    self.assertEqual((self.root / "victim").read_text(encoding="utf-8"), "secret")
                    # A link in place of a result goes, not what it points at.
                    os.remove(self.results / name)
                    os.symlink(self.root / "victim", self.results / name)
                    if name != "manifest.txt":
                        self.run_well(ranks=ranks)
                    self.assertEqual((self.root / "victim").read_text(encoding="utf-8"), "secret")
                    os.rename(self.results, self.root / f"after {len(os.listdir(self.root))}")

    def test_links_under_names_of_temporary_files_are_left_alone(self):
        names = [".rhexis-write-test", "history.csv.part", "run.json.part", "run.json.spare", "particles.xdmf.part",
                 "checkpoints/step_000005.h5.part"]
        self.put("victim", text="secret")
        (self.results / "checkpoints").mkdir(parents=True)
        for name in names:
            os.symlink(self.root / "victim", self.results / name)
        self.run_well()
        self.assertEqual((self.root / "victim").read_text(encoding="utf-8"), "secret")
        self.assertEqual(self.contents("r").keys(), RESULTS | set(names))

    def test_folders_that_are_links_are_refused(self):
        for name in ("images", "checkpoints"):
            self.put("other/a_1.png", "other/step_000005.h5")
            self.results.mkdir(exist_ok=True)
            os.symlink("../other", self.results / name)
            for more in ([], ["--overwrite"]):
                self.assert_refused([f"r/{name}: it is a link", "not followed"], *more)
            os.remove(self.results / name)
        # The results folder itself may be one.
        os.rmdir(self.results)
        os.symlink("other", self.results)
        self.run_well()
        self.assertEqual(self.contents("other").keys(), RESULTS | {"a_1.png", "step_000005.h5"})

    # -- names --------------------------------------------------------------------------------------------------

    def test_long_paths(self):
        part = "e" * 240
        for depth, ranks in ((1, None), (1, 2), (14, None)):
            path = "/".join([part] * depth)
            result = self.rhexis("run", "vessel.toml", "-o", path, "--quiet", ranks=ranks)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
        before = self.contents()
        for path in ("/".join([part] * 17), "f" * 256):
            result = self.rhexis("run", "vessel.toml", "-o", path, "--quiet")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("File name too long; choose another folder with -o", result.stderr)
        self.assertEqual(self.contents(), before)

    def test_a_link_that_leads_nowhere_is_refused(self):
        os.symlink("nowhere", self.results)
        self.assert_refused(["r: it is a link that leads nowhere; choose another folder with -o"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
