# SPDX-License-Identifier: BSD-3-Clause
"""What people have met: each fault's case as a row, with how the run must end, what it must say, and that it leaves files alone.

Run by ctest as: test_fault_table.py RHEXIS
"""

import csv
import dataclasses
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from coupled_case import at_once  # noqa: E402
from study.program import changes, snapshot  # noqa: E402
from study.results import differences, found_by  # noqa: E402
from study.scenes import vtp_network  # noqa: E402

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
NETWORK = '[scene]\nmodel = "network"\n[network]\nsource = "file"\nfiles = ["junctions.csv", "vessels.csv"]\n'
VTP_NETWORK = NETWORK.replace('"junctions.csv", "vessels.csv"', '"network.vtp"') + 'file_length_unit = "mm"\n'
JUNCTIONS = "id,x [mm],y [mm],z [mm],pressure [mmHg]\nin,0,0,0,100\nout,10,0,0,90\n"
VESSELS = "id,from,to,radius [mm]\n1,in,out,1\n"


@dataclasses.dataclass
class Fault:
    name: str
    status: int
    said: list  # phrases of the one error message
    files: dict = dataclasses.field(default_factory=dict)  # beside s.toml: name -> text or bytes; "-> target" for a link
    scene: str = VESSEL
    command: list = dataclasses.field(default_factory=lambda: ["run", "s.toml", "-o", "out", "--quiet"])
    environment: dict = dataclasses.field(default_factory=dict)


# A folder of the user's that looks like results, but that no run has made.
LOOKS_LIKE_RESULTS = {f"out/{name}": f"my {name}\n" for name in (
    "notes.txt", "coupling.csv", "vessels.csv", "network.vtp", "movie.mp4", "checkpoints/mine.h5", "images/holiday_001.png", "images/IMG_20240101.png",
    "event_2024/history.csv", "event_2024/images/party_12.png")}

# Links in a results folder; what they point at is the user's.
LINKS = {f"out/{name}": f"-> {up}victim/{target}" for name, up, target in (
    ("history.csv", "../", "hist"), ("run.json", "../", "run"), ("particles.h5", "../", "h5"), ("particles.xdmf", "../", "xdmf"),
    ("history.csv.part", "../", "part"), ("run.json.spare", "../", "spare"), (".rhexis-write-test", "../", "probe"), ("images", "../", "images"),
    ("checkpoints/step_000010.h5", "../../", "cp"), ("checkpoints/step_000020.h5.part", "../../", "cp"))}
VICTIMS = {f"victim/{name}": "SECRET\n" for name in ("hist", "run", "h5", "xdmf", "part", "spare", "probe", "images/x_001.png", "cp")}

FOLDERS = [
    Fault("results over a VTP file that is read", 2, ["network.vtp"], {"network.vtp": vtp_network()}, VTP_NETWORK,
          ["run", "s.toml", "-o", ".", "--quiet", "--set", "network.vtp=true"]),
    Fault("results beside a VTP file that is read", 0, [], {"network.vtp": vtp_network()}, VTP_NETWORK, ["run", "s.toml", "-o", ".", "--quiet"]),
    Fault("links in the results folder", 2, ["link"], {**LINKS, **VICTIMS}),
    Fault("links to what no result is called", 0, [], {**{name: to for name, to in LINKS.items() if name.endswith(("part", "spare", "test"))},
                                                       **VICTIMS}),
    Fault("a results folder of 240 letters", 0, [], command=["run", "s.toml", "-o", "e" * 240, "--quiet"]),
    Fault("results over the input", 2, ["vessels.csv"], {"junctions.csv": JUNCTIONS, "vessels.csv": VESSELS}, NETWORK, ["run", "s.toml", "-o", ".",
                                                                                                                        "--quiet"]),
    Fault("a file of the user's where a result must go", 2, ["history.csv"], {**LOOKS_LIKE_RESULTS, "out/history.csv": "mine\n"}),
    Fault("files of the user's beside the results", 0, [], LOOKS_LIKE_RESULTS),
]


INPUTS = [
    Fault("a wall of 600 mm in particles of 250 um", 2, ["vessel.outer_radius", "would fit"], scene=VESSEL.replace('"2 mm"', '"622.1436517410052 mm"'), command=["check",
                                                                                                                                       "s.toml"]),
    Fault("a wall of two metres", 2, ["vessel.outer_radius", "would fit"], scene=VESSEL.replace('"2 mm"', '"2 m"'), command=["check", "s.toml"]),
    Fault("a key that begins with an accent", 2, ["s.toml:5", "'é'"], scene=VESSEL.replace("[discretisation]", "élength = 1\n[discretisation]")),
]


def of_dataset(name, change):
    def damage(file):
        data = file[name][()]
        change(data)
        file[name][...] = data
    return damage


def flip_a_bit(data):
    data.view("u1").flat[data.nbytes // 2] ^= 1


def other_number(name, value):
    def damage(file):
        del file.attrs[name]
        file.attrs[name] = value
    return damage


# Damage to a checkpoint, and what the refusal names.
CHECKPOINTS = [
    ("3 x 3 numbers where one was", other_number("step", numpy.ones((3, 3), "i8")), "step"),
    ("a text where a number was", other_number("load_speed", "fast"), "load_speed"),
    ("a step that is never reached", other_number("step", -4_600_000_000_000_000_000), "numbers"),
    ("work beyond all", other_number("external_work_0", 1e308), "numbers"),
    ("a bit of a displacement", of_dataset("displacement_x", flip_a_bit), "displacement_x"),
    ("a bit of a bond", of_dataset("intact_bonds", flip_a_bit), "intact_bonds"),
    ("a bit of the input", of_dataset("input", flip_a_bit), "input"),
]


def script(*lines, channel="particles"):
    """A script that asks for a channel and does nothing else, and these lines."""
    return "\n".join([f'from paraview.simple import *\nparticles = PVTrivialProducer(registrationName="{channel}")', *lines]) + "\n"


def exported(name, file, *lines):
    """As ParaView writes it (File, Save Catalyst State) of a reader of saved results, with a table in place of a picture."""
    return f"""\
from paraview.simple import *
particlesxdmf = XDMFReader(registrationName='{name}', FileNames=['{file}'])
particlesxdmf.PointArrayStatus = ['damage', 'displacement']
table = CreateExtractor('CSV', particlesxdmf, registrationName='CSV1')
table.Writer.FileName = 'table_{{timestep:06d}}.csv'
from paraview import catalyst
options = catalyst.Options()
options.GlobalTrigger = 'TimeStep'
""" + "\n".join(lines)


EARLIER = "earlier/particles_from_000100.xdmf"


def drawing(name, status, said, scripts, *settings):
    """A run that a script, or several, looks at."""
    names = [f"{chr(ord('a') + i)}.py" for i in range(len(scripts))]
    words = [word for setting in (f"insitu.scripts={names}".replace("'", '"'), *settings) for word in ("--set", setting)]
    return Fault(name, status, said, dict(zip(names, scripts)), command=["run", "s.toml", "-o", "out", "--quiet", *words])


SCRIPTS = [
    drawing("no Python", 2, ["a.py, line 1", "SyntaxError"], ["def f(:\n"]),
    drawing("two scripts whose files have one name", 2, ["b.py", "table_", "a.py"], [exported("particles", EARLIER)] * 2),
    drawing("a writer of volumes on points", 2, ["a.py, line 9", "VTU"],
            [exported("particles", EARLIER, "v = CreateExtractor('VTU', particlesxdmf)", "v.Writer.FileName = 'v_{timestep:06d}.vtu'")]),
    drawing("a writer of many blocks on points", 2, ["a.py, line 9", "VTPD"],
            [exported("particles", EARLIER, "v = CreateExtractor('VTPD', particlesxdmf)", "v.Writer.FileName = 'v_{timestep:06d}.vtpd'")]),
    drawing("files outside of the images' folder", 2, ["a.py", "../../table.csv", "outside"],
            [script("t = CreateExtractor('CSV', particles)", "t.Writer.FileName = '../../table.csv'")]),
    drawing("a name that is none", 3, ["a.py, line 3", "Shwo"], [script("Shwo(particles)")]),
    drawing("a field that is none", 3, ["a.py", "Damage", "damage"], [script("ColorBy(Show(particles, CreateRenderView()), ('POINTS', 'Damage'))")]),
    drawing("no end", 3, ["a.py", "insitu.time_limit"],
            [script("def catalyst_execute(info):", "    while True: pass")], "insitu.time_limit=2 s"),
    drawing("an end of its own", 3, ["a.py, line 5", "os._exit"], [script("import os", "def catalyst_execute(info):", "    os._exit(0)")]),
    drawing("a live view that nobody watches", 0, [],
            [script("from paraview import catalyst", "options = catalyst.Options()", "options.EnableCatalystLive = 1",
                    "options.CatalystLiveURL = 'localhost:22222'")]),
    drawing("another working folder", 3, ["a.py", "working folder"], [script("import os", "def catalyst_execute(info):", "    os.chdir('/')")]),
]
# Readers of what earlier runs saved, under whatever name: they show this run.
EXPORTED = [exported(name, file) for name, file in (
    ("particles", EARLIER), ("particles_from_000100.xdmf", EARLIER), ("vessel_run7.xdmf", EARLIER), ("vessel_run7.xdmf", "/nowhere/particles.xdmf"))]
# Writes into the data that it is lent, and takes them away.
MUTATES = script("""
def catalyst_execute(info):
    data = particles.GetClientSideObject().GetOutputDataObject(0)
    damage, points = data.GetPointData().GetArray("damage"), data.GetPoints().GetData()
    for i in range(damage.GetNumberOfTuples()):
        damage.SetComponent(i, 0, 7.0)
        points.SetComponent(i, 0, 1e9)
    data.GetPointData().Initialize()
    data.SetPoints(None)
""")


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

    def test_folders(self):
        self.check_all(FOLDERS)

    def test_scripts(self):
        self.needs_pictures()
        self.check_all(SCRIPTS)

    def test_earlier_results_stay_until_scripts_compile(self):
        self.needs_pictures()
        fault = drawing("", 2, ["SyntaxError"], ["def f(:\n"])
        folder = self.prepare(fault, "stay")
        self.assertEqual(self.rhexis(folder, ["run", "s.toml", "-o", "out", "--quiet"]).returncode, 0)
        before = snapshot(folder)
        self.assertEqual(self.rhexis(folder, fault.command).returncode, 2)
        self.assertEqual(changes(before, snapshot(folder)), [])

    def test_exported_scripts_show_this_run(self):
        """Tables of four scripts, whose readers name results of another run, are those of one that asks for the channel."""
        self.needs_pictures()
        live = script("table = CreateExtractor('CSV', particles)", "table.Writer.FileName = 'live_{timestep:06d}.csv'")
        others = [text.replace("table_", f"other_{i}_") for i, text in enumerate(EXPORTED)]
        fault = drawing("", 0, [], [live, *others])
        folder = self.prepare(fault, "shown")
        earlier = self.rhexis(folder, ["run", "s.toml", "-o", "earlier", "--quiet", "--set", "load.pressure=50 kPa", "--set",
                                       "output.checkpoint_every=0"])
        self.assertEqual(earlier.returncode, 0, earlier.stderr)
        for ending in ("h5", "xdmf"):
            os.rename(folder / f"earlier/particles.{ending}", folder / f"earlier/particles_from_000100.{ending}")
        result = self.rhexis(folder, fault.command)
        self.assertEqual(result.returncode, 0, result.stderr)

        def displacements(name):
            with open(folder / f"out/images/{name}_000020.csv", encoding="utf-8") as file:
                return [row["displacement:0"] for row in csv.DictReader(file)]

        expected = displacements("live")
        self.assertGreater(len(set(expected)), 100)
        for i, text in enumerate(EXPORTED):
            self.assertEqual(displacements(f"other_{i}"), expected, text)

    def test_scripts_do_not_change_results(self):
        self.needs_pictures()
        fault = drawing("", 0, [], [MUTATES])
        folder = self.prepare(fault, "mutated")
        self.assertEqual(self.rhexis(folder, ["run", "s.toml", "-o", "alone", "--quiet"]).returncode, 0)
        self.rhexis(folder, fault.command)
        alone, mutated = found_by(folder / "alone"), found_by(folder / "out")
        self.assertEqual(differences(alone, mutated), [])

    def needs_pictures(self):
        if "Catalyst" not in self.rhexis(self.path, ["--version"]).stdout:
            self.skipTest("built without ParaView")

    def test_inputs(self):
        self.check_all(INPUTS)


    def test_checkpoints(self):
        good = self.prepare(Fault("", 0, []), "good")
        result = self.rhexis(good, ["run", "s.toml", "-o", "out", "--quiet"])
        self.assertEqual(result.returncode, 0, result.stderr)
        faults = []
        for name, damage, said in CHECKPOINTS:
            with h5py.File(io.BytesIO((good / "out/checkpoints/step_000010.h5").read_bytes()), "r+") as file:
                damage(file)
                file.flush()
                damaged = file.id.get_file_image()
            faults.append(Fault(name, 2, ["damaged.h5", said], {"damaged.h5": damaged}, command=["run", "s.toml", "-o", "out", "--quiet", "--restart",
                                                                                                 "damaged.h5"]))
        self.check_all(faults)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
