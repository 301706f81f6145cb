# SPDX-License-Identifier: BSD-3-Clause
"""Pictures while the program runs, on a synthetic vessel and network (insitu_driver): pictures, failing scripts."""

import json
import sys
import unittest
import unittest.mock
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from insitu_case import BUILT, ENVIRONMENT, NETWORK, SOURCE, VESSEL, DriverTest, like, main, read

MINIMAL = 'from paraview.simple import *\nparticles = PVTrivialProducer(registrationName="particles")\n'
RANK = "from paraview.vtk.vtkParallelCore import vtkMultiProcessController\n" \
       "rank = vtkMultiProcessController.GetGlobalController().GetLocalProcessId()\n"


@unittest.skipUnless(BUILT, "built without ParaView")
class Pictures(DriverTest):
    def check_picture(self, path):
        picture = read(path)
        self.assertEqual(picture.shape, (720, 1280, 3))
        frame = numpy.concatenate([picture[[0, -1], :630].reshape(-1, 3), picture[:, [0, 630, 1279]].reshape(-1, 3)])
        self.assertTrue((frame == 255).all(), "something is clipped")
        body = ~like(picture, 255, 3)
        left, right = body[60:630, :640], body[60:630, 640:]
        for half in (left, right):
            rows, columns = numpy.nonzero(half)
            self.assertGreater(numpy.ptp(rows), 500)
            self.assertGreater(half.sum(), 80_000)
            self.assertAlmostEqual(columns.mean(), 280, delta=40)
        return picture

    def test_pictures_are_the_same_on_1_2_and_4_ranks(self):
        pictures = []
        for ranks in (1, 2, 4):
            self.run_driver(VESSEL, ranks=ranks)
            names = sorted(path.name for path in self.images.iterdir())
            self.assertEqual(names, ["vessel_000000.png", "vessel_000050.png"])
            pictures.append(self.check_picture(self.images / names[-1]))
            if ranks == 1:
                self.check_colours(read(self.images / names[0]), pictures[0])
        # Shades where a ridge of spheres meets another may differ by the order in which ranks are composed.
        for other in pictures[1:]:
            self.assertLess((numpy.abs(other - pictures[0]).max(axis=-1) > 8).mean(), 1e-3)

    def check_colours(self, rest, torn):
        # Displacement: at rest only the dark end of the map; torn, also the green and yellow of 1 to 2 mm.
        yellowish = lambda picture: ((picture[..., 1] > picture[..., 2] + 60) & (picture[..., 1] > 90))[60:630, :640]
        self.assertEqual(yellowish(rest).sum(), 0)
        self.assertGreater(yellowish(torn).sum(), 1000)
        # Damage: at rest all grey; torn, red lips.
        reddish = lambda picture: (picture[..., 0] > picture[..., 1] + 60)[60:630, 640:]
        self.assertEqual(reddish(rest).sum(), 0)
        self.assertGreater(reddish(torn).sum(), 1000)

    def test_nothing_that_could_be_seen_is_left_out(self):
        self.run_driver(VESSEL)
        path = self.images / "vessel_000050.png"
        fewer = read(path)
        path.unlink()
        script = self.script(
            f"import sys\nsys.path.append({str(VESSEL.parent)!r})\nimport numpy, vessel_picture\n"
            "vessel_picture.VesselPicture._seen = lambda self, position: numpy.arange(len(position))\n"
            + VESSEL.read_text()
        )
        self.run_driver(script)
        different = (numpy.abs(read(path) - fewer) > 2).any(axis=-1)
        self.assertLess(different.mean(), 1e-3)  # where spheres of the same depth meet, the first drawn wins

    def test_fields_and_image_directory(self):
        script = self.script(
            'fields = ["damage"]\n' + MINIMAL +
            "from paraview import catalyst\n"
            "view = CreateRenderView(ViewSize=[64, 64])\n"
            "Show(particles, view)\n"
            'extract = CreateExtractor("PNG", view, registrationName="x")\n'
            'extract.Writer.FileName = "small_{timestep:06d}.png"\n'
            "extract.Trigger = 'TimeStep'\nextract.Trigger.Frequency = 100\n"
            "options = catalyst.Options()\noptions.ExtractsOutputDirectory = 'datasets'\n",
            "numpy.py",  # the name of another module
        )
        lines = [json.loads(line) for line in self.run_driver(script, frames=4)]
        self.assertEqual([line["wanted"] for line in lines[1:5]], [1, 0, 1, 0])
        self.assertEqual(lines[-1]["asked"], {"damage": 2})
        self.assertEqual(sorted(path.name for path in self.images.iterdir()), ["small_000000.png", "small_000100.png"])
        self.assertFalse((self.folder / "datasets").exists())

    def test_script_made_in_paraview_for_the_saved_file(self):
        script = self.script(
            "from paraview import catalyst\nfrom paraview.simple import *\noptions = catalyst.Options()\n"
            'source = XDMFReader(registrationName="particles.xdmf", FileNames=["/elsewhere/particles.xdmf"])\n'
            'source.PointArrayStatus = ["damage"]\n'
            "def catalyst_execute(info):\n"
            '    source.UpdatePipeline()\n'
            '    assert source.PointData["damage"].GetRange()[1] <= 0.5\n'
            '    data = source.GetClientSideObject().GetOutputDataObject(0)\n'
            '    assert data.GetFieldData().GetArray("pressure").GetTuple1(0) == 238e3\n'
            '    assert data.GetNumberOfPoints() == data.GetNumberOfCells() == 54800\n'
        )
        asked = json.loads(self.run_driver(script)[-1])["asked"]
        self.assertEqual(asked, {"damage": 2})

    def test_egl_draws_the_same(self):
        template = SOURCE / "catalyst_scripts" / "template.py"
        lines = self.run_driver(template, frames=1, renderer="osmesa")
        self.assertIn("OSMesa", lines[0])
        first = read(self.images / "damage_000000.png")
        self.assertGreater((~like(first, 255)).mean(), 0.1)
        lines = self.run_driver(template, frames=1, renderer="egl")
        self.assertIn("EGL", lines[0])
        self.assertLess((numpy.abs(read(self.images / "damage_000000.png") - first).max(axis=-1) > 8).mean(), 1e-3)


def reddish(picture):
    return (picture[..., 0] > picture[..., 1] + 70) & (picture[..., 0] > picture[..., 2] + 70)


def bluish(picture):
    return (picture[..., 2] > picture[..., 0] + 50) & (picture[..., 2] > picture[..., 1] + 30)


@unittest.skipUnless(BUILT, "built without ParaView")
class Networks(DriverTest):
    def picture(self, channels, ranks=1, frames=1):
        self.run_driver(NETWORK, channels=channels, ranks=ranks, frames=frames)
        picture = read(self.images / "network_000000.png")
        self.assertEqual(picture.shape, (720, 1280, 3))
        edge = numpy.concatenate([picture[[0, -1]].reshape(-1, 3), picture[:, [0, -1]].reshape(-1, 3)])
        self.assertTrue((edge == 255).all(), "something is clipped")
        return picture

    def check_tree(self, picture):
        """Side by side: red left of blue in the left view; both as large as in the right view, of other colours."""
        left, right = picture[60:600, :640], picture[60:600, 640:]
        red, blue = numpy.nonzero(reddish(left)), numpy.nonzero(bluish(left))
        self.assertGreater(min(len(red[0]), len(blue[0])), 3000)
        self.assertLess(red[1].mean() + 200, blue[1].mean())
        self.assertEqual(reddish(right).sum(), 0)
        for half in (left, right):
            rows, columns = numpy.nonzero(~like(half, 255, 3))
            self.assertGreater(numpy.ptp(columns), 560)
            self.assertGreater(numpy.ptp(rows), 250)
        yellow = (right[..., 0] > 200) & (right[..., 1] > 180) & (right[..., 2] < 110)
        self.assertGreater(yellow.sum(), 150, "no high pressure")
        self.assertLess(numpy.nonzero(yellow)[1].mean(), 150, "high pressures are not where blood comes in")

    def test_pictures_are_the_same_on_1_2_and_4_ranks(self):
        for kind in ("planar", "spatial"):
            pictures = [self.picture(f"network:{kind}", ranks) for ranks in (1, 2, 4)]
            self.check_tree(pictures[0])
            for other in pictures[1:]:
                # Where vessels meet at the same depth, the first drawn wins.
                self.assertLess((numpy.abs(other - pictures[0]).max(axis=-1) > 8).mean(), 1e-3)

    def test_ranks_without_vessels(self):
        alone, shared = self.picture("network:1"), self.picture("network:1", ranks=4)
        self.assertLess((numpy.abs(shared - alone).max(axis=-1) > 8).mean(), 1e-3)

    def test_flow_is_shown_where_nobody_knows_the_kinds(self):
        picture = self.picture("network:unknown")
        self.assertEqual(reddish(picture).sum(), 0)
        first, inner = picture[335, 40:140], picture[180:500, 290:350]
        self.assertTrue((first.sum(axis=-1) < 300).all(), "the largest flow is dark")
        self.assertGreater(((inner[..., 0] > 150) & (inner[..., 1] > 180) & (inner[..., 2] < 100)).sum(), 200)

    def test_thousands_of_vessels_leave_white_between_them(self):
        picture = self.picture("network:spatial:11", frames=2)
        body = picture[60:600, :640]
        covered = (~like(body, 255, 3)).mean()
        self.assertGreater(covered, 0.08)
        self.assertLess(covered, 0.5)

    def test_only_fields_asked_for_are_computed(self):
        report = json.loads(self.run_driver(NETWORK, channels="both")[-1])
        self.assertEqual(report["asked"], {})
        self.assertEqual(report["asked_of_network"], dict.fromkeys(["flow", "kind", "pressure", "radius"], 2))
        report = json.loads(self.run_driver(VESSEL, NETWORK, channels="both")[-1])
        self.assertEqual(report["asked"], {"damage": 2, "displacement": 2})
        names = [f"{name}_{step:06d}.png" for name in ("network", "vessel") for step in (0, 50)]
        self.assertEqual(sorted(path.name for path in self.images.iterdir()), names)

    def test_both_channels_as_paraview_sees_them(self):
        script = self.script(
            'network_fields = ["pressure", "flow"]\nfrom paraview.simple import *\n'
            'network = XDMFReader(registrationName="network.xdmf", FileNames=["/elsewhere/network.xdmf"])\n'
            'particles = PVTrivialProducer(registrationName="particles")\n'
            "def catalyst_execute(info):\n"
            "    network.UpdatePipeline(), particles.UpdatePipeline()\n"
            "    data = network.GetClientSideObject().GetOutputDataObject(0)\n"
            "    assert (data.GetNumberOfPoints(), data.GetNumberOfCells(), data.GetNumberOfLines()) == (60, 30, 30)\n"
            "    assert [data.GetCell(29).GetPointId(end) for end in (0, 1)] == [58, 59]\n"
            '    assert data.GetPointData().GetArray("pressure").GetTuple1(0) == 13332\n'
            '    assert abs(data.GetCellData().GetArray("flow").GetTuple1(29) / (5e-3 / 60 / 8) - 1) < 1e-12\n'
            '    assert data.GetPointData().GetArray("flow") is None\n'
            '    assert data.GetFieldData().GetArray("vessels").GetTuple1(0) == 34359738366\n'
            '    assert data.GetFieldData().GetArray("step").GetTuple1(0) == info.timestep\n'
            '    assert particles.PointData["damage"].GetRange()[1] <= 0.5\n'
        )
        report = json.loads(self.run_driver(script, channels="both")[-1])
        self.assertEqual(report["asked_of_network"], {"flow": 2, "pressure": 2})
        self.assertEqual(len(report["asked"]), 5)  # the script says nothing of the particles' fields

    def test_missing_channel(self):
        for script, channels, missing in ((NETWORK, "particles", "network"), (VESSEL, "network", "particles")):
            for ranks in (1, 2):
                self.assertIn(
                    f"Catalyst script {script}: asks for the channel '{missing}', which this run does not have; "
                    f"there are: {channels}",
                    self.failure(script, channels=channels, ranks=ranks),
                )

    def test_unknown_field_and_bad_list(self):
        script = self.script('network_fields = ["presure"]\n')
        self.assertIn(f"{script}, line 1: asks for the field 'presure'; there are: pressure, flow, ",
                      self.failure(script, channels="network"))
        script = self.script("network_fields = 5\n")
        self.assertIn('line 1: network_fields must be a list of names, e.g. network_fields = ["pressure"]',
                      self.failure(script, channels="network"))

    def test_picture_that_cannot_be_written(self):
        (self.images / "network_000050.png").mkdir(parents=True)
        self.assertRegex(self.failure(NETWORK, ranks=2, channels="network"),
                         r"network.py, line \d+: IsADirectoryError: .*network_000050.png")


class Absent(DriverTest):
    def reason(self, folder):
        with unittest.mock.patch.dict(ENVIRONMENT, RHEXIS_PLUGIN_DIR=str(folder)):
            return self.run_driver(VESSEL, status=4)[0]

    def test_without_plugin_the_reason_is_given(self):
        built = f"there is no {self.folder}/librhexis_catalyst.so"
        self.assertIn(built if BUILT else "when Rhexis was built", self.reason(self.folder).replace("with RHEXIS_INSITU=OFF", "when Rhexis was built"))

    @unittest.skipUnless(BUILT, "built without ParaView")
    def test_a_plugin_that_cannot_be_loaded(self):
        (self.folder / "librhexis_catalyst.so").write_text("no library")
        self.assertIn("not available: " + str(self.folder / "librhexis_catalyst.so") + ": file too short", self.reason(self.folder))


@unittest.skipUnless(BUILT, "built without ParaView")
class Failures(DriverTest):
    def test_what_is_missing_is_named(self):
        lines = self.run_driver(VESSEL, renderer="x11", status=4)
        self.assertIn("DISPLAY", lines[0])
        missing = self.folder / "missing.py"
        self.assertEqual(self.failure(missing, ranks=2),
                         f"Catalyst script {missing}: No such file or directory (on rank 0)")

    def test_package_with_an_error(self):
        package = self.folder / "package"
        package.mkdir()
        (package / "__init__.py").write_text(MINIMAL + "from .part import nothing\n")
        (package / "part.py").write_text("")
        self.assertIn(f"{package / '__init__.py'}, line 3: ImportError: cannot import name 'nothing'",
                      self.failure(package))

    def test_raising_at_start_on_one_rank(self):
        script = self.script(RANK + MINIMAL + "if rank == 1: 1 / 0\n")
        self.assertEqual(self.failure(script, ranks=2),
                         f"Catalyst script {script}, line 5: ZeroDivisionError: division by zero (on rank 1)")

    def test_raising_what_is_no_text_on_one_rank(self):
        script = self.script(RANK + MINIMAL + 'if rank == 1: raise RuntimeError("caf\\udce9")\n')
        self.assertEqual(self.failure(script, ranks=2),
                         f"Catalyst script {script}, line 5: RuntimeError: caf\\udce9 (on rank 1)")

    def test_raising_at_a_later_frame(self):
        script = self.script(MINIMAL + "def catalyst_execute(info):\n  if info.timestep == 50: raise SystemExit(7)\n")
        self.assertEqual(self.failure(script), f"Catalyst script {script}, line 4: SystemExit: 7")

    def test_raising_at_the_end(self):
        script = self.script(MINIMAL + "def catalyst_finalize(): raise KeyError(1)\n")
        self.assertEqual(self.failure(script), f"Catalyst script {script}, line 3: KeyError: 1")

    def test_raising_in_a_filter(self):
        script = self.script(
            MINIMAL + 'f = ProgrammableFilter(Input=particles, Script="raise ValueError(5)")\n'
            "def catalyst_execute(info): f.UpdatePipeline()\n"
        )
        self.assertEqual(self.failure(script), f"Catalyst script {script}: ValueError: 5")

    def test_picture_that_cannot_be_written(self):
        (self.images / "vessel_000050.png").mkdir(parents=True)
        self.assertRegex(self.failure(VESSEL, ranks=2), r"vessel.py, line \d+: IsADirectoryError: .*vessel_000050.png")

    def test_stuck_ranks_end_the_run(self):
        script = self.script(RANK + MINIMAL + "def catalyst_execute(info):\n  if rank == 1: 1 / 0\n"
                             "  vtkMultiProcessController.GetGlobalController().Barrier()\n")
        self.run_driver(script, ranks=2, status=3)
        self.assertIn(f"error: Catalyst script {script}, line 6: ZeroDivisionError: division by zero (on rank 1;",
                      self.errors)


if __name__ == "__main__":
    main()
