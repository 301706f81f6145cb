# SPDX-License-Identifier: BSD-3-Clause
"""Users' scripts as they really are, on a synthetic vessel and network: exported states, scripts that do harm, that hang."""

import json
import sys
import unittest
import unittest.mock
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import synthetic_run
from insitu_case import BUILT, ENVIRONMENT, SOURCE, VESSEL, DriverTest, main

SIMPLE = "from paraview.simple import *\n"
MINIMAL = SIMPLE + 'particles = PVTrivialProducer(registrationName="particles")\n'
# At every step: that a source shows this step of the run, which has as many points as `count`.
CHECK = """
def check(source, info, count):
    source.UpdatePipeline()
    data = source.GetClientSideObject().GetOutputDataObject(0)
    step = data.GetFieldData().GetArray("step")
    assert step and step.GetTuple1(0) == info.timestep, "not of this run"
    assert data.GetNumberOfPoints() == count, data.GetNumberOfPoints()
"""


@unittest.skipUnless(BUILT, "built without ParaView")
class Exported(DriverTest):
    def test_readers_of_any_results_become_sources_of_the_run(self):
        earlier = self.folder / "earlier"
        synthetic_run.write(earlier, frames=1, length_m=1e-3)
        for name in ("particles_from_000100.xdmf", "mine.xdmf"):
            (earlier / name).write_text((earlier / "particles.xdmf").read_text())
        state = self.script(
            SIMPLE + CHECK +
            f"a = XDMFReader(registrationName='vessel_run7.xdmf', FileNames=['{earlier}/particles_from_000100.xdmf'])\n"
            "a.PointArrayStatus = ['damage']\n"
            f"b = Xdmf3ReaderS(FileName=['{earlier}/mine.xdmf'])\n"
            "b.PointArrays = ['displacement']\n"
            f"c = OpenDataFile('{earlier}/particles.xdmf')\n"
            "c.PointArrayStatus = ['damage']\n"
            "n = XDMFReader(registrationName='any', FileNames=['/gone/network.xdmf'])\n"
            "def catalyst_execute(info):\n"
            "    for source in (a, b, c): check(source, info, 54800)\n"
            "    check(n, info, 60)\n"
            "    assert FindSource('vessel_run7.xdmf') is not None\n", "state.py")  # fmt: skip
        compared = self.script(
            f"saved_files = ['{earlier}/particles.xdmf']\n" + MINIMAL + CHECK +
            f"old = XDMFReader(FileNames=['{earlier}/particles.xdmf'])\n"
            "def catalyst_execute(info):\n"
            "    check(particles, info, 54800)\n"
            "    old.UpdatePipeline()\n"
            "    assert old.GetDataInformation().GetNumberOfPoints() == 5480\n", "compared.py")  # fmt: skip
        report = json.loads(self.run_driver(state, compared, channels="both")[-1])
        self.assertEqual({name: report["asked"][name] for name in ("damage", "displacement", "velocity")},
                         {"damage": 4, "displacement": 4, "velocity": 2})  # fmt: skip

    def test_a_saved_file_is_not_drawn_in_place_of_the_run(self):
        synthetic_run.write(self.folder, frames=1, length_m=1e-3)
        script = self.script(MINIMAL + "old = servermanager.sources.XDMFReader(FileNames=['particles' + '.xdmf'])\n")
        self.assertIn(f"Catalyst script {script}, line 3: RuntimeError: 'particles.xdmf' holds saved results",
                      self.failure(script, ranks=2))

    def test_names_and_colours_that_are_computed(self):
        for text, message in (
            ("wall = STLReader(FileNames=['/nowhere/wall.stl'])\n", "line 3: FileNotFoundError: there is no file '/nowhere/wall.stl'"),
            ("view = CreateRenderView()\nColorBy(Show(particles, view), ('POINTS', 'Damage'))\n",
             "line 4: colours by 'Damage', which the data do not have; there are: "),
            ("for n in '12': CreateExtractor('PNG', CreateRenderView()).Writer.FileName = '../' + 'a.png'\n", "'../a.png' lies outside"),
            ("for n in '12': CreateExtractor('PNG', CreateRenderView()).Writer.FileName = 'a' + '.png'\n", "files named 'a.png' are also"),
        ):  # fmt: skip
            with self.subTest(text):
                script = self.script(MINIMAL + text)
                failure = self.failure(script)
                self.assertIn(f"Catalyst script {script}", failure)
                self.assertIn(message, failure)
                self.assertEqual(self.errors, "")

    def test_an_error_of_vtk_is_one_message(self):
        script = self.script(MINIMAL + "glyphs = Glyph(Input=particles)\nCreateExtractor('VTU', glyphs)\n")
        failure = self.failure(script)
        self.assertIn(f"Catalyst script {script}: VTK: Input for connection index 0", failure)
        self.assertIn("is of type vtkPolyData, but a vtkUnstructuredGridBase is required", failure)
        self.assertEqual(self.errors, "")


@unittest.skipUnless(BUILT, "built without ParaView")
class Harm(DriverTest):
    def test_what_a_script_does_to_its_data_is_not_seen_by_others(self):
        mutate = self.script(
            'fields = ["damage"]\n' + MINIMAL +
            "from vtkmodules.util.numpy_support import vtk_to_numpy\n"
            "def catalyst_execute(info):\n"
            "    data = particles.GetClientSideObject().GetOutputDataObject(0)\n"
            '    vtk_to_numpy(data.GetPointData().GetArray("damage"))[:] = 7\n'
            "    vtk_to_numpy(data.GetPoints().GetData())[:] = 1e9\n"
            "    vtk_to_numpy(data.GetVerts().GetConnectivityArray())[:] = 0\n"
            "    data.GetPointData().Initialize()\n"
            "    data.SetPoints(None)\n", "mutate.py")  # fmt: skip
        check = self.script(
            MINIMAL + "def catalyst_execute(info):\n"
            "    particles.UpdatePipeline()\n"
            '    assert particles.PointData["damage"].GetRange()[1] <= 0.5\n'
            "    data = particles.GetClientSideObject().GetOutputDataObject(0)\n"
            "    assert data.GetNumberOfPoints() == 54800 and data.GetBounds()[1] < 1\n"
            "    assert data.GetCell(54799).GetPointId(0) == 54799\n", "check.py")  # fmt: skip
        self.run_driver(mutate, check, frames=3)  # the synthetic vessel's values are added to those of the step before

    def test_the_process_is_left_as_it_was(self):
        script = self.script(
            'fields = ["damage"]\nimport locale, os, signal\n'
            "def catalyst_execute(info):\n"
            "    os.chdir('/')\n"
            "    signal.signal(signal.SIGTERM, signal.SIG_IGN)\n"
            "    signal.alarm(1)\n"
            "    os.environ['OMP_NUM_THREADS'] = '99'\n"
            "    os.environ['MPLBACKEND'] = 'Agg'\n"
            "    os.umask(0o777)\n"
            "    os.close(1)\n")  # fmt: skip
        self.assertEqual(
            self.failure(script),
            f"Catalyst script {script}: it changed the working folder from {self.folder.resolve()} to /; replaced the "
            "handler of SIGTERM; set a timer that sends SIGALRM; changed the file mode mask; closed or redirected standard "
            "output; changed the environment variable OMP_NUM_THREADS, which the program relies on")  # fmt: skip

    def test_a_script_cannot_end_the_program(self):
        script = self.script('fields = ["damage"]\nimport os\ndef catalyst_execute(info): os._exit(0)\n')
        self.assertEqual(self.failure(script), f"Catalyst script {script}, line 3: RuntimeError: os._exit would end the program; "
                                               "raise an exception to end the run")  # fmt: skip

    def test_two_scripts_of_one_name(self):
        scripts = []
        for folder in ("a", "b"):
            (self.folder / folder).mkdir()
            scripts.append(self.script(f'fields = []\ndef catalyst_execute(info): print("from {folder}", flush=True)\n', f"{folder}/s.py"))
        lines = self.run_driver(*scripts, frames=1)
        self.assertEqual([line for line in lines if "from" in line], ["from a", "from b"])


@unittest.skipUnless(BUILT, "built without ParaView")
class TimeLimit(DriverTest):
    def setUp(self):
        super().setUp()
        limit = unittest.mock.patch.dict(ENVIRONMENT, DRIVER_TIME_LIMIT="1")
        limit.start()
        self.addCleanup(limit.stop)

    def test_python_code_is_interrupted(self):
        script = self.script(
            "fields = []\ndef catalyst_execute(info):\n  while True:\n    try:\n      while True: pass\n    except Exception: pass\n")
        self.assertEqual(self.failure(script), f"Catalyst script {script}, line 5: not done after 1 s (insitu.time_limit)")

    def test_a_script_inside_a_library_ends_the_program(self):
        script = self.script("fields = []\nimport time\ndef catalyst_execute(info):\n  while True:\n    try: time.sleep(1000)\n"
                             "    except: pass\n")  # fmt: skip
        lines = self.run_driver(script, status=3)
        message = f"Catalyst script {script}: not done after 1 s (insitu.time_limit)"
        self.assertIn(f"record: {message}", lines)
        self.assertEqual(self.errors, f"error: {message}\n")


if __name__ == "__main__":
    main()
