"""A vessel of a network, coupled, as a user meets it: wrong input, load, bleeding, ranks, restarts.

Run by ctest as: test_coupled.py RHEXIS MPIRUN...   (with /usr/bin/python3, which has h5py)
"""

import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np

RHEXIS, *MPIRUN = sys.argv[1:]

MMHG = 133.322387415  # Pa
BLOOD_VISCOSITY, BLOOD_DENSITY, DISCHARGE = 3.5e-3, 1060, 0.62  # Pa s, kg/m3: the program's defaults

# Three vessels in a row, the middle one of 144 columns x 24 rows: a second for a run.
JUNCTIONS = """\
id,x [mm],y [mm],z [mm],pressure [mmHg]
heart,-100,0,0,200
neck,-2,10,0,
brain,4,20,0,
vein,50,0,0,20
"""
VESSELS = """\
id,from,to,radius [mm],length [mm],wall_thickness [mm]
feeder,heart,neck,1.2,300,0.4
artery,neck,brain,1.5,6,0.75
bed,brain,vein,0.3,50,0.1
"""
TWO_WAY = """\
[scene]
model = "coupled"

[network]
source = "file"
files = ["j.csv", "v.csv"]

[blood]
viscosity_law = "constant"

[coupling]
vessel = "artery"
mode = "two_way"
window = "20 us"

[material]
critical_stretch = 0.015

[discretisation]
cross_section = "lattice"
spacing = "250 um"

[load]
layer = "consistent"
schedule = "smooth_ramp"
ramp_time = "0.8 ms"

[time]
step = "5 us"
end = "1.6 ms"

[output]
every_steps = 4
precision = "double"
"""
TREE = """\
[scene]
model = "coupled"

[tree]
generations = 12
root_radius = "2 mm"
asymmetry = 0.9
least_asymmetry = 0.4

[wall]
artery_ratio = 0.75

[flow]
inlet_pressure = "200 mmHg"
outlet_pressure = "5 mmHg"

[coupling]
vessel = "artery.0"

[discretisation]
particles = 3200

[time]
end = "0.2 ms"

[output]
every_steps = 50
"""


def changed(text, key, new):
    """`text` with another line for the one of `key`."""
    lines = text.splitlines()
    (place,) = (i for i, line in enumerate(lines) if line.startswith(f"{key} ="))
    return "\n".join([*lines[:place], new, *lines[place + 1:]]) + "\n"


ONE_WAY = changed(TWO_WAY, "mode", "")
TORN_TREE = changed(TREE, "vessel", 'vessel = "artery.0"\nmode = "two_way"\nwindow = "20 us"\nresolution = "paper"')
TORN_TREE = changed(TORN_TREE, "end", 'end = "0.8 ms"') + """\
[load]
layer = "consistent"
schedule = "smooth_ramp"
ramp_time = "0.2 ms"
[material]
critical_stretch = 0.016
"""
TORN_TREE = TORN_TREE.replace("artery_ratio = 0.75", "artery_ratio = 0.5").replace("[wall]", "length_ratio = 4\n[wall]")
TORN_TREE = TORN_TREE.replace("[discretisation]", '[discretisation]\ncross_section = "lattice"')
SHORT = {"j.csv": JUNCTIONS, "v.csv": VESSELS.replace(",6,0.75", ",0.3,0.75")}
PLACELESS = "id,pressure [mmHg]\nheart,200\nneck,\nbrain,\nvein,20\n"
CUFF = '[body]\ncompression = "10 mmHg"\n'

# Those that several ranks find out in different ways: all of them or the first for all, before, after and without the network's solution.
BY_TWO_RANKS = {"id beyond the last", "absent from the file", "rows of a piece", "collapse", "checkpoints of two-way coupling"}
# name, input, what the message says: file, line, key and value, as a regular expression, and what is allowed; other files
WRONG = [
    ("energy release rate without horizon", changed(TWO_WAY, "critical_stretch", 'energy_release_rate = "1 J/m2"'),
     [r'c\.toml:\d+: material\.energy_release_rate = "1 J/m2": ', "discretisation.horizon"]),
    ("id beyond the last", changed(TREE, "vessel", 'vessel = "8190"'), [r'c\.toml:18: coupling\.vessel = "8190": ', "0 to 8189"]),
    ("path with a two", changed(TREE, "vessel", 'vessel = "artery.0120"'), [r'c\.toml:18: coupling\.vessel = "artery.0120": ', "0 and 1"]),
    ("absent from the file", changed(TWO_WAY, "vessel", 'vessel = "nerve"'), [r'c\.toml:12: coupling\.vessel = "nerve": ', r"v\.csv"]),
    ("no vessel", changed(TWO_WAY, "vessel", ""), [r"c\.toml: coupling\.vessel is missing", "its path in a tree"]),
    ("rows of a piece", changed(TWO_WAY, "spacing", "particles = 1000"), [r"c\.toml:21: discretisation\.particles = 1000: ", "5 spacings", "10 rows"]),
    ("rows of a whole vessel", changed(TWO_WAY, "spacing", "particles = 30000"), [r"c\.toml:21: discretisation\.particles = 30000: ", "10 spacings"], SHORT),
    ("rows without a choice", changed(TWO_WAY, "spacing", ""), [r'c\.toml: discretisation\.particles \(default "auto"\): ', "10 spacings"], SHORT),
    ("shorter than a spacing", changed(TWO_WAY, "spacing", 'spacing = "350 um"'),
     [r"c\.toml:\d+: (coupling\.vessel|discretisation\.spacing) = ", "300 um"], SHORT),
    ("collapse", TWO_WAY + '[body]\ncompression = "300 mmHg"\n', [r"c\.toml:\d+: (body|coupling)\.\w+ = ", "artery", r"Eq\. \(?7", "collapse", r"-1..\.\d mmHg"]),
    ("collapse by tissue", TWO_WAY + '[body]\ntissue_tension = "300 mmHg"\n', [r"c\.toml:\d+: (body|coupling)\.\w+ = ", "artery", "collapse"]),
    ("window below a step", changed(TWO_WAY, "window", 'window = "4 us"'), [r'c\.toml:14: coupling\.window = "4 us": ', "5 us"]),
    ("window beyond the end", changed(TWO_WAY, "window", 'window = "2 ms"'), [r'c\.toml:14: coupling\.window = "2 ms": ', r"time\.end = 1\.6 ms"]),
    ("cuff beyond the body", TWO_WAY + CUFF + 'compression_from = "1 m"\ncompression_to = "2 m"\n',
     [r'c\.toml:37: body\.compression_from = "1 m": ', r"-0\.1 m to 0\.05 m"]),
    ("cuff before the body", TWO_WAY + CUFF + 'compression_to = "-1 m"\n', [r'c\.toml:37: body\.compression_to = "-1 m": ', r"-0\.1 m to 0\.05 m"]),
    ("cuff beyond a tree", TREE + CUFF + 'compression_from = "9 m"\n', [r'c\.toml:30: body\.compression_from = "9 m": ', "reaches from"]),
    ("cuff the wrong way round", TWO_WAY + CUFF + 'compression_from = "2 cm"\ncompression_to = "1 cm"\n',
     [r'c\.toml:38: body\.compression_to = "1 cm": ', "above body.compression_from"]),
    ("cuff without places", TWO_WAY + CUFF + 'compression_from = "0 m"\n',
     [r'c\.toml:37: body\.compression_from = "0 m": ', "coordinates"], {"j.csv": PLACELESS, "v.csv": VESSELS}),
    ("weight without places", TWO_WAY + '[flow]\nacceleration = ["0 m/s2", "9 m/s2", "0 m/s2"]\n',
     [r"c\.toml:36: flow\.acceleration = ", "coordinates"], {"j.csv": PLACELESS, "v.csv": VESSELS}),
    ("distributed file", changed(TWO_WAY, "source", 'source = "file"\ntier = "distributed"'),
     [r'c\.toml:6: network\.tier = "distributed": ', "implicit or explicit"]),
    ("section of a vessel's scene", TWO_WAY + '[vessel]\nlength = "2 mm"\n', [r"c\.toml:35: section \[vessel\]", r'scene\.model = "vessel"', '"coupled"']),
    ("pressure", changed(TWO_WAY, "ramp_time", 'pressure = "10 kPa"'), [r'c\.toml:26: load\.pressure = "10 kPa": ', "network"]),
    ("table", changed(TWO_WAY, "schedule", 'schedule = "table"'), [r'c\.toml:25: load\.schedule = "table": ', "network"]),
    ("checkpoints of two-way coupling", changed(TWO_WAY, "precision", "checkpoint_every = 9"), [r"c\.toml:34: output\.checkpoint_every = 9: ", "two.way"]),
]


def resistance(radius, length):
    return 8 * BLOOD_VISCOSITY * length / (math.pi * radius**4)


FEEDER, ARTERY, BED = resistance(1.2e-3, 0.3), resistance(1.5e-3, 6e-3), resistance(0.3e-3, 0.05)


def bleeding(share, factor, opening, outside, weight):
    """The artery as a tube of two halves, with a hole between them, fed through the feeder and drained by the bed.

    `share` of all pressures acts; `factor` is on the artery's resistance; `outside` and `weight` (Eq. 7: tension and
    compression; P_g) hold at its beginning, middle and end. Net pressures there, leak, inflow, outflow.
    """
    heart, vein = 200 * MMHG * share, 20 * MMHG * share
    outside, weight = [share * p for p in outside], [share * p for p in weight]
    up, down = FEEDER + factor * ARTERY / 2, factor * ARTERY / 2 + BED

    def leak(p):
        return DISCHARGE * opening * math.sqrt(2 * max(p + weight[1] - outside[1], 0) / BLOOD_DENSITY)

    low, high = -heart, heart
    for _ in range(200):
        p = (low + high) / 2
        low, high = (p, high) if (heart - p) / up - (p - vein) / down > leak(p) else (low, p)
    flows = (heart - p) / up, (vein - p) / down
    places = heart - flows[0] * FEEDER, p, vein - flows[1] * BED
    net = [max(p + g - o, 0) for p, g, o in zip(places, weight, outside)]  # collapse is not modelled
    return net, leak(p), sum(max(q, 0) for q in flows), sum(max(-q, 0) for q in flows)


def at_once(function, argument_lists):
    """What `function` returns for each: starting a program is mostly waiting."""
    with ThreadPoolExecutor(4) as pool:
        return list(pool.map(lambda arguments: function(*arguments), argument_lists))


class Coupled(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="rhexis_coupled_")
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        self.write({"j.csv": JUNCTIONS, "v.csv": VESSELS})

    def write(self, files):
        for name, text in files.items():
            (self.path / name).write_text(text, encoding="utf-8")

    def rhexis(self, *arguments, ranks=None, threads=None, cwd=None):
        launcher = [*MPIRUN, "-n", str(ranks)] if ranks else []
        environment = {**os.environ, "OMP_NUM_THREADS": str(threads)} if threads else None
        return subprocess.run([*launcher, RHEXIS, *arguments], cwd=cwd or self.path, capture_output=True, text=True, timeout=300,
                              stdin=subprocess.DEVNULL, env=environment, check=False)

    def run_well(self, scene, folder, *overrides, more=(), **launch):
        """Runs `scene` into `folder`; its results without what differs from run to run: times."""
        self.write({f"{folder}.toml": scene})
        settings = [word for override in overrides for word in ("--set", override)]
        result = self.rhexis("run", f"{folder}.toml", "--quiet", "-o", folder, *settings, *more, **launch)
        self.assertEqual(result.returncode, 0, result.stderr)
        record = json.loads((self.path / folder / "run.json").read_text())
        self.assertEqual(record["status"], "completed")
        for key in ("network_s", "exchange_s"):
            (record["results"]["coupling"] or {}).pop(key, None)
        return record["results"]

    def rows(self, file):
        with open(self.path / file, encoding="utf-8") as stream:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(stream)]

    def assert_close(self, a, b, relative, message=None):
        self.assertLessEqual(abs(a - b), relative * abs(b), (a, b, message))

    def assert_same_data(self, a, b):
        """Every data set of two HDF5 files, bit for bit."""
        with h5py.File(self.path / a) as one, h5py.File(self.path / b) as other:
            names = [], []
            one.visit(names[0].append)
            other.visit(names[1].append)
            self.assertEqual(*names)
            data = [name for name in names[0] if isinstance(one[name], h5py.Dataset) and not name.endswith("unplanned")]
            self.assertGreater(len(data), 5)
            for name in data:
                self.assertEqual(one[name][()].tobytes(), other[name][()].tobytes(), name)

    # -- wrong input ---------------------------------------------------------------------------------------------

    def refuse(self, case, ranks, *command):
        """Runs it in a folder of its own; the result, and what it left there."""
        name, text, _, *files = case
        files = {"c.toml": text, "j.csv": JUNCTIONS, "v.csv": VESSELS, **(files[0] if files else {})}
        folder = self.path / f"{name} {ranks}"
        folder.mkdir()
        self.write({folder / file: content for file, content in files.items()})
        result = self.rhexis(*(command or ("run", "c.toml")), ranks=ranks, cwd=folder)
        return result, sorted(set(os.listdir(folder)) - set(files))

    def assert_refused(self, result, left, patterns):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("rhexis: "), 1, f"not one message: {result.stderr}")
        for pattern in patterns:
            self.assertRegex(result.stderr, pattern)
        self.assertEqual(left, [], "something was written")

    def test_wrong_inputs(self):
        cases = [(case, None) for case in WRONG] + [(case, 2) for case in WRONG if case[0] in BY_TWO_RANKS]
        self.assertEqual(len(cases), len(WRONG) + len(BY_TWO_RANKS))
        for (case, ranks), outcome in zip(cases, at_once(self.refuse, cases), strict=True):
            with self.subTest(case[0], ranks=ranks):
                self.assert_refused(*outcome, case[2])
        outcome = self.refuse(("restart", TWO_WAY, []), None, "run", "c.toml", "--restart", "x.h5")
        self.assert_refused(*outcome, ["--restart", "two.way"])

    def test_check(self):
        self.write({"two_way.toml": TWO_WAY, "tree.toml": TREE})
        before = sorted(os.listdir(self.path))
        for scene, patterns in (("two_way.toml", ["artery", "3,456", "stable", "mmHg"]),
                                ("tree.toml", [r"artery\.0", "3,190", "piece", "stable", "mmHg"])):
            with self.subTest(scene):
                result = self.rhexis("check", scene)
                self.assertEqual(result.returncode, 0, result.stderr)
                for pattern in patterns:
                    self.assertRegex(result.stdout, pattern)
        self.assertEqual(sorted(os.listdir(self.path)), before)
        cuff = next(case for case in WRONG if case[0] == "cuff beyond the body")
        self.assert_refused(*self.refuse(cuff, None, "check", "c.toml"), cuff[2])

    # -- the load ------------------------------------------------------------------------------------------------

    def test_without_flow_it_is_the_standalone_vessel(self):
        """The whole vessel, and the piece of it that the constant-N rule leaves; both tear and are vented."""
        self.write({"j.csv": JUNCTIONS.replace(",20\n", ",200\n")})
        network, wall = ONE_WAY.split("[material]")
        wall = changed(changed(changed(wall, "step", ""), "end", 'end = "0.7 ms"'), "every_steps", "every_steps = 40")
        wall = changed(changed(wall, "critical_stretch", "critical_stretch = 0.01"), "ramp_time", 'ramp_time = "0.2 ms"') + '[boundary]\nends = "sliding"\n'
        area = math.pi * (2.25e-3**2 - 1.5e-3**2)
        for name, particles, spacing in (("whole", 'spacing = "250 um"', "250 um"), ("piece", "particles = 4400", f"{0.75e-3 / 5!r} m")):
            with self.subTest(name):
                c = self.run_well(f"{network}[material]{changed(wall, 'spacing', particles)}", name)
                vessel, length, start = (c["coupling"][key] for key in ("vessel", "simulated_length_m", "simulated_from_m"))
                self.assertEqual(c["coupling"]["net_pressure_Pa"], [200 * MMHG] * 3)
                alone = changed(wall, "spacing", f'spacing = "{spacing}"').replace("[load]", '[load]\npressure = "200 mmHg"')
                radii = vessel["radius_m"], vessel["radius_m"] + vessel["wall_thickness_m"]
                alone = self.run_well('[vessel]\ninner_radius = "{!r} m"\nouter_radius = "{!r} m"\nlength = "{!r} m"\n'.format(*radii, length)
                                      + f"[material]{alone}", "alone")
                self.assertIsNotNone(alone["rupture_onset_s"])
                self.assertLess(self.rows("alone/history.csv")[-1]["pressure_Pa"], 199 * MMHG)
                for key in set(c) - {"network", "coupling"}:
                    self.assertEqual(c[key], alone[key], key)
                self.assertEqual((self.path / name / "history.csv").read_bytes(), (self.path / "alone/history.csv").read_bytes())
                self.assert_same_data(f"{name}/particles.h5", "alone/particles.h5")
        self.assert_close(c["coupling"]["spacing_of_constant_N_m"], (area * 6e-3 / 4400) ** (1 / 3), 1e-12)
        self.assert_close(length, 4400 * 150e-6**3 / area, 1e-12)
        self.assertAlmostEqual(start + length / 2, 3e-3, delta=1e-15)

    def test_a_vessel_of_a_tree(self):
        """What the network says of the vessel is what a plain network scene says; the wall is loaded with it."""
        plain = TREE.split("[discretisation]")[0].replace('model = "coupled"', 'model = "network"').replace("[coupling]", "[network]")
        plain = changed(plain, "vessel", 'query = ["artery.0", "vein.1"]')
        coupled = changed(TREE, "end", 'end = "20 us"')
        weight, ends = "flow.acceleration=['4 m/s2', '-9 m/s2', '2 m/s2']", {}
        runs = [("implicit", [], None), ("explicit", [weight], 2)]
        for (tier, settings, _), p, c in zip(runs, at_once(self.run_well, [(plain, f"plain_{t}", *s, f"network.tier={t}") for t, s, _ in runs]),
                                             at_once(lambda t, s, ranks: self.run_well(coupled, t, *s, f"network.tier={t}", "network.query=['vein.1']",
                                                                                       ranks=ranks), runs)):
            vessel = c["coupling"]["vessel"]
            self.assertEqual(vessel, p["network"]["queries"][0])
            self.assertEqual(c["network"]["queries"], p["network"]["queries"][1:])
            ends[tier] = vessel["pressure_from_Pa"], vessel["pressure_to_Pa"]
            expected = [ends[tier][0], sum(ends[tier]) / 2, ends[tier][1]]
            self.assertGreater(expected[0] - expected[2], 100)
            for net, pressure in zip(c["coupling"]["net_pressure_Pa"], expected, strict=True):
                self.assert_close(net, pressure, 1e-14)
            self.assert_close(self.rows(f"{tier}/history.csv")[-1]["pressure_Pa"], expected[0], 1e-14)
            self.assertFalse((self.path / tier / "coupling.csv").exists())
            for key in ("windows", "leak_m3_s", "leaked_m3", "max_imbalance"):
                self.assertIsNone(c["coupling"][key])
        self.assertGreater(abs(ends["implicit"][0] - ends["explicit"][0]), 10)  # the weight is there

    def test_every_term_of_the_net_pressure(self):
        """Eq. (7); P_g twice: across the direction between heart and vein, and along it, where it changes the flow."""
        flow, places = 180 * MMHG / (FEEDER + ARTERY + BED), (0, 0.5, 1)
        heart = [200 * MMHG - flow * (FEEDER + place * ARTERY) for place in places]
        tension, atmosphere, cuff = 3 * MMHG, -5 * MMHG, 11 * MMHG
        terms = [f"body.{key} mmHg" for key in ("tissue_tension=3", "atmosphere=-5", "compression=11")]
        weight = [-9.81 * BLOOD_DENSITY * (10e-3 + place * 10e-3) for place in places]
        driving = 180 * MMHG + 7 * BLOOD_DENSITY * 0.15  # heart and vein are 150 mm apart
        along = [200 * MMHG + 7 * BLOOD_DENSITY * (0.1 - 2e-3 + place * 6e-3) - driving * flow / (180 * MMHG) * (FEEDER + place * ARTERY)
                 for place in places]
        cases = [([terms[2], "body.compression_from=-1 mm", "body.compression_to=2 mm"], [heart[0], heart[1] - cuff, heart[2]]),
                 ([terms[2], "body.compression_axis=y", "body.compression_to=16 mm"], [heart[0] - cuff, heart[1] - cuff, heart[2]]),
                 (["flow.acceleration=['7 m/s2','0 m/s2','0 m/s2']"], along),
                 ([*terms, "flow.acceleration=['0 m/s2','-9.81 m/s2','3 m/s2']"],
                  [p + g - tension - atmosphere - cuff for p, g in zip(heart, weight)])]
        scene = changed(changed(ONE_WAY, "end", 'end = "20 us"'), "ramp_time", 'ramp_time = "40 us"')
        runs = at_once(self.run_well, [(scene, str(i), "load.schedule=ramp", *settings) for i, (settings, _) in enumerate(cases)])
        for i, ((settings, expected), run) in enumerate(zip(cases, runs)):
            for net, pressure in zip(run["coupling"]["net_pressure_Pa"], expected, strict=True):
                self.assertAlmostEqual(net, pressure, delta=1e-7, msg=settings)
            # Half way up the ramp the wall has half of the largest.
            self.assertAlmostEqual(self.rows(f"{i}/history.csv")[-1]["pressure_Pa"], max(expected) / 2, delta=1e-7)

    def test_a_cuff_is_on_the_body_and_not_on_what_is_shown_of_it(self):
        c = self.run_well(changed(TREE, "end", 'end = "20 us"') + CUFF, "out", "body.compression_from=-400 mm", "body.compression_to=-100 mm",
                          "network.shown_subtree=artery.11111111")["coupling"]
        self.assert_close(c["net_pressure_Pa"][0], c["vessel"]["pressure_from_Pa"] - 10 * MMHG, 1e-14)

    def test_the_load_falls_along_the_vessel(self):
        """A vessel with nearly the whole drop bulges most where blood enters; turned round, the picture is mirrored."""
        def bulge(name, ends):
            self.write({f"{name}.csv": VESSELS.replace("neck,brain", ends).replace("1.2,300", "1.5,0.6").replace("0.3,50", "1.5,0.6")})
            self.run_well(changed(ONE_WAY, "critical_stretch", ""), name, "time.end=1 ms", "output.every_steps=200", f"network.files=['j.csv', '{name}.csv']")
            with h5py.File(self.path / name / "particles.h5") as file:
                x, u = file["reference_position"][:], file["displacement/000200"][:]
            radial = (x[:, :2] * u[:, :2]).sum(axis=1) / np.hypot(x[:, 0], x[:, 1])
            row = np.rint(x[:, 2] / 250e-6 - 0.5).astype(int)
            return np.bincount(row, radial) / np.bincount(row)

        there, back = at_once(bulge, [("there", "neck,brain"), ("back", "brain,neck")])
        self.assertEqual(len(there), 24)
        self.assertGreater(there[:12].mean() / there[12:].mean(), 1.3)
        np.testing.assert_allclose(there, back[::-1], atol=1e-4 * there.max())

    # -- two ways ------------------------------------------------------------------------------------------------

    def test_bleeding_agrees_with_two_resistances_and_an_orifice(self):
        """In every row, with a cuff on the artery's end, tissue all around, and weight; and the wall feels it."""
        results = self.run_well(TWO_WAY, "out", "body.tissue_tension=3 mmHg", "body.compression=6 mmHg", "body.compression_from=2 mm",
                                "flow.acceleration=['0 m/s2','-9.81 m/s2','0 m/s2']", "output.fields=[]")
        surroundings = [3 * MMHG, 3 * MMHG, 9 * MMHG], [-9.81 * BLOOD_DENSITY * y for y in (10e-3, 15e-3, 20e-3)]
        rows, history = self.rows("out/coupling.csv"), self.rows("out/history.csv")
        self.assertEqual([row["time_s"] for row in rows], [row["time_s"] for row in history])
        self.assertEqual(len(rows), 81)
        closed = bleeding(1, 1, 0, *surroundings)[0]
        largest, factor, leaked, before = max(closed), 1, 0, None
        for row, wall in zip(rows, history):
            share = 0.5 - 0.5 * math.cos(math.pi * min(row["time_s"] / 0.8e-3, 1))
            self.assertAlmostEqual(row["schedule"], share, delta=1e-14)
            net, leak, inflow, outflow = bleeding(share, row["resistance_factor"], row["opening_m2"], *surroundings)
            found = [row[f"net_pressure_{place}_Pa"] for place in ("from", "middle", "to")]
            for a, b in zip(found, net):
                self.assertAlmostEqual(a, b, delta=1e-9 * 200 * MMHG, msg=row)
            for key, expected in (("leak", leak), ("inflow", inflow), ("outflow", outflow)):
                self.assertAlmostEqual(row[f"{key}_m3_s"], expected, delta=1e-9 * inflow, msg=row)
            self.assertLessEqual(row["imbalance"], 1e-10)
            self.assertAlmostEqual(row["inflow_m3_s"] - row["outflow_m3_s"], row["leak_m3_s"], delta=1e-10 * inflow)
            # The wall has the pressure of the exchange before, raised by the schedule, and the opening of now.
            self.assertAlmostEqual(wall["pressure_Pa"], share * largest, delta=1e-12 * 200 * MMHG)
            self.assertEqual((wall["opening_m2"], wall["leak_m3_s"]), (row["opening_m2"], row["leak_m3_s"]))
            largest = max(found) / share if share else largest
            # The lumen widens, if less at held ends; from rupture on it counts as it was then.
            if row["time_s"] < results["rupture_onset_s"]:
                widest = 1 - (1 + wall["max_displacement_m"] / 1.5e-3) ** -4
                factor = row["resistance_factor"]
                self.assertTrue(0.2 * widest <= 1 - factor <= widest, row)
            elif row["time_s"] > results["rupture_onset_s"] + 20e-6:
                self.assertEqual(row["resistance_factor"], rows[-1]["resistance_factor"])
            leaked += before["leak_m3_s"] * (row["time_s"] - before["time_s"]) if before else 0
            before = row
        # It tore and bled as much as the feeder lets through, and that relieved it.
        self.assertLess(rows[-1]["net_pressure_middle_Pa"], 0.2 * closed[1])
        self.assert_close(rows[-1]["leak_m3_s"], 200 * MMHG / FEEDER, 0.1)
        c = results["coupling"]
        self.assertEqual((c["windows"], c["mode"], c["leak_m3_s"]), (81, "two_way", rows[-1]["leak_m3_s"]))
        self.assert_close(c["leaked_m3"], leaked, 1e-12)
        self.assertEqual(c["max_imbalance"], max(row["imbalance"] for row in rows))
        self.assertEqual(c["net_pressure_at_end_Pa"], found)
        for first, expected in zip(c["net_pressure_Pa"], closed, strict=True):
            self.assertAlmostEqual(first, expected, delta=1e-7)
        self.assertLess(abs(results["energy_drift"]), 1e-3)

    def test_finer_windows_converge(self):
        """With the first order where the wall bears its load. Fragments are chaotic: of a torn one, what it leaked settles."""
        # Resistances alike, so that the lumen matters.
        self.write({"soft.csv": VESSELS.replace("1.2,300", "1.5,10").replace("0.3,50", "1.5,3")})
        soft = ["network.files=['j.csv', 'soft.csv']", "material.young_modulus=100 kPa", "material.critical_stretch=2", "time.step=10 us",
                "time.end=2.56 ms", "load.ramp_time=2.56 ms"]
        windows = 80, 40, 20  # us
        runs = at_once(self.run_well, [(TWO_WAY, f"{name}_{window}", f"coupling.window={window} us", "output.every_steps=256", *settings)
                                       for name, settings in (("soft", soft), ("torn", [])) for window in windows])
        self.assertEqual([run["coupling"]["windows"] for run in runs[:3]], [2560 // window + 1 for window in windows])
        factors = [self.rows(f"soft_{window}/coupling.csv")[-1]["resistance_factor"] for window in windows]
        self.assertLess(factors[2], 0.7)  # a third of its resistance is gone
        for coarse, middle, fine in (factors, [run["max_displacement_m"] for run in runs[:3]],
                                     *zip(*(run["coupling"]["net_pressure_at_end_Pa"] for run in runs[:3]))):
            self.assertTrue(0.3 < (fine - middle) / (middle - coarse) < 0.7, (coarse, middle, fine))
        coarse, middle, fine = (run["coupling"]["leaked_m3"] for run in runs[3:])
        self.assertLess(abs(fine - middle), 0.7 * abs(middle - coarse), (coarse, middle, fine))
        self.assert_close(middle, fine, 0.04)

    def test_a_window_by_default_is_never_shorter_than_a_step(self):
        results = self.run_well(changed(TWO_WAY, "window", ""), "out", "time.end=0.2 ms")  # 40 steps
        self.assertEqual(results["coupling"]["windows"], 41)

    # -- tiers, ranks, threads, restarts -------------------------------------------------------------------------

    def test_tiers_agree(self):
        runs = at_once(self.run_well, [(TORN_TREE, tier, f"network.tier={tier}", "material.young_modulus=1 MPa", "material.critical_stretch=2")
                                       for tier in ("implicit", "explicit")])
        self.assertLess(self.rows("implicit/coupling.csv")[-1]["resistance_factor"], 0.99)
        for one, other in zip(*(run["coupling"]["net_pressure_at_end_Pa"] for run in runs), strict=True):
            self.assert_close(one, other, 1e-9)

    def test_ranks_and_threads_change_nothing(self):
        """A vessel of a file's network and one of a tree, that tear and bleed into it."""
        for name, scene, table, first, second in (("file", changed(TWO_WAY, "end", 'end = "1 ms"'), "vessels.csv", (None, 1), (2, 2)),
                                                  ("tree", TORN_TREE, "generations.csv", (None, 2), (2, 1))):
            with self.subTest(name):
                one, other = (self.run_well(scene, folder, "output.every_steps=40", ranks=ranks, threads=threads)
                              for folder, (ranks, threads) in (("one", first), ("other", second)))
                self.assertGreater(one["coupling"]["leaked_m3"], 0)
                self.assertLessEqual(one["coupling"]["max_imbalance"], 1e-10)
                self.assertEqual(other, one)
                for file in ("history.csv", "coupling.csv", table):
                    self.assertEqual((self.path / "one" / file).read_bytes(), (self.path / "other" / file).read_bytes(), file)
                for file in ("particles.h5", "network.h5"):
                    self.assert_same_data(f"one/{file}", f"other/{file}")

    def test_restart_goes_on_bit_by_bit(self):
        results = self.run_well(ONE_WAY, "whole", "time.end=1 ms", "output.checkpoint_every=130")
        whole = self.rows("whole/history.csv")
        self.assertGreater(whole[32]["broken_bonds"], 0)  # at step 128
        more = ["--restart", "whole/checkpoints/step_000130.h5"]
        rest = self.run_well(ONE_WAY, "rest", "time.end=1 ms", more=more, ranks=2)
        for key in set(results) - {"energy_drift"}:
            self.assertEqual(rest[key], results[key], key)
        for row, expected in zip(self.rows("rest/history.csv")[1:], whole[33:], strict=True):
            # Work is a sum that is exact until it is stored, rounded, with a checkpoint.
            self.assert_close(row.pop("external_work_J"), expected.pop("external_work_J"), 1e-14)
            self.assertEqual(row, expected)
        with h5py.File(self.path / "whole/particles.h5") as a, h5py.File(self.path / "rest/particles_from_000130.h5") as b:
            for field in ("position", "velocity", "damage"):
                self.assertTrue((a[f"{field}/000200"][:] == b[f"{field}/000200"][:]).all(), field)
        # The geometry is the network's, and a checkpoint is of one body.
        self.write({"v.csv": VESSELS.replace(",6,0.75", ",7,0.75")})
        refused = self.rhexis("run", "rest.toml", "-o", "x", *more)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("another body", refused.stderr)
        self.assertFalse((self.path / "x").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
