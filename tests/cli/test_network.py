# SPDX-License-Identifier: BSD-3-Clause
"""The program on networks, as a user meets it: runs, records, tables, wrong input, ranks.

Run by ctest as: test_network.py RHEXIS SOURCE_DIR MPIRUN...
"""

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

RHEXIS, SOURCE, *MPIRUN = sys.argv[1:]

TREE = """\
[scene]
model = "network"

[tree]
generations = 12
root_radius = "2 mm"
asymmetry = 0.9
least_asymmetry = 0.4
length_spread = 0.2

[flow]
inlet_pressure = "90 mmHg"
outlet_pressure = "5 mmHg"

[network]
query = ["artery.", "vein.0110", "4095"]
shown_vessels = 300
"""
JUNCTIONS = "id,x [mm],y [mm],z [mm],pressure [mmHg]\na,0,0,0,10\nb,3,4,0,\nc,3,4,12,0\n"
VESSELS = "id,from,to,radius [um]\n1,a,b,50\n2,b,c,40\n"
FILES = """\
[scene]
model = "network"
[network]
source = "file"
files = ["j.csv", "v.csv"]
"""


def tree(line_start, new):
    return "\n".join(new if line.startswith(line_start) else line for line in TREE.splitlines()) + "\n"


# name, input, what the message must contain
WRONG = [
    ("section of the other model", TREE + "[vessel]\nlength = \"2 mm\"\n", ["[vessel]", "scene.model", "vessel", "network"]),
    ("network section in a vessel scene", TREE.replace('model = "network"', ""), ["[tree]", "scene.model"]),
    ("model", tree("model", 'model = "tree"'), ["scene.model", "vessel", "network"]),
    ("no generations", tree("generations", ""), ["tree.generations", "1 to 40"]),
    ("too many generations", tree("generations", "generations = 41"), ["tree.generations", "40"]),
    ("radius without unit", tree("root_radius", "root_radius = 2"), ["tree.root_radius", "unit"]),
    ("terminal radius above the root's", tree("asymmetry", 'terminal_radius = "3 mm"'), ["tree.terminal_radius", "below"]),
    ("both exponent and terminal radius", tree("asymmetry", 'terminal_radius = "3 um"\nradius_exponent = 3'), ["both"]),
    ("asymmetries swapped", tree("least_asymmetry", "least_asymmetry = 0.95"), ["tree.least_asymmetry", "asymmetry"]),
    ("lengths of too few generations", tree("length_spread", "length_ratio_by_generation = [10, 20]"), ["length_ratio_by_generation", "12"]),
    ("curve of one point", tree("length_spread", 'length_by_radius = [["1 mm", "2 mm"]]'), ["length_by_radius", "two"]),
    ("curve that falls back", tree("length_spread", 'length_by_radius = [["2 mm", "2 mm"], ["1 mm", "2 mm"]]'), ["length_by_radius", "increase"]),
    ("one condition", tree("outlet_pressure", ""), ["flow.inlet_pressure", "two"]),
    ("three conditions", tree("outlet_pressure", 'outlet_pressure = "5 mmHg"\ninlet_flow = "1 L/min"'), ["two"]),
    ("absent vessel", tree("query", 'query = ["artery.0120"]'), ["network.query", "0120", "0 and 1"]),
    ("vessel beyond the last", tree("query", 'query = ["8190"]'), ["network.query", "8189"]),
    ("path too long", tree("query", 'query = ["vein.000000000000"]'), ["network.query", "11 steps"]),
    ("acceleration of two components", tree("outlet_pressure", 'outlet_pressure = "5 mmHg"\nacceleration = ["1 m/s2", "0 m/s2"]'), ["flow.acceleration", "three"]),
    ("phase separation without a graph", TREE + "[blood]\nphase_separation = true\n", ["blood.phase_separation", "explicit"]),
    ("one file of two", TREE.replace("[network]", '[network]\nsource = "file"\nfiles = ["j.csv"]'), ["network.files", "j.csv", "two .csv"]),
    ("files of a tree", TREE.replace("[network]", '[network]\nfiles = ["j.csv"]'), ["network.files", "source"]),
    ("haematocrit of one", TREE + "[blood]\nhaematocrit = 1\n", ["blood.haematocrit"]),
    ("huge explicit tree", tree("generations", "generations = 34").replace("[network]", '[network]\ntier = "explicit"'), ["network.tier", "implicit"]),
    ("huge distributed tree", tree("generations", "generations = 40").replace("[network]", '[network]\ntier = "distributed"'), ["network.tier", "GB"]),
    ("daughters of nothing", tree("least_asymmetry", "least_asymmetry = 1e-4\nradius_exponent = 6"), ["tree.least_asymmetry", "narrower daughter"]),
    ("vessels thinner than molecules", tree("asymmetry", "asymmetry = 1e-3\nradius_exponent = 2").replace("least_asymmetry = 0.4\n", ""), ["tree.asymmetry", "narrowest", "m"]),
    ("absent script", TREE + '[insitu]\nscripts = ["nowhere.py"]\n', ["insitu.scripts", "nowhere.py"]),
]
# name, junctions, vessels, message
WRONG_FILES = [
    ("floating component", JUNCTIONS + "d,9,9,9,\ne,9,9,8,\n", VESSELS + "3,d,e,50\n", ["junction d", "pressure"]),
    ("negative radius", JUNCTIONS, VESSELS.replace(",50", ",-50"), ["v.csv:2", "radius"]),
    ("zero length", JUNCTIONS.replace("3,4,0", "0,0,0"), VESSELS, ["v.csv:2", "length"]),
    ("nan", JUNCTIONS, VESSELS.replace(",50", ",nan"), ["v.csv:2", "nan"]),
    ("self loop", JUNCTIONS, VESSELS.replace("1,a,b", "1,a,a"), ["v.csv:2", "itself"]),
    ("duplicate", JUNCTIONS, VESSELS.replace("2,b", "1,b"), ["v.csv:3", "already"]),
    ("unknown junction", JUNCTIONS, VESSELS.replace("1,a", "1,q"), ["v.csv:2", "from = q"]),
    ("cut short", JUNCTIONS, VESSELS[:-6], ["v.csv:3", "cut short"]),
    ("unit missing", JUNCTIONS, VESSELS.replace(" [um]", ""), ["v.csv:1", "radius", "unit"]),
    ("wrong dimension", JUNCTIONS, VESSELS.replace("[um]", "[mmHg]"), ["v.csv:1", "radius"]),
]


class Network(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="rhexis_network_")
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def write(self, name, text):
        (self.path / name).write_text(text, encoding="utf-8")

    def rhexis(self, *arguments, ranks=None):
        launcher = [*MPIRUN, "-n", str(ranks)] if ranks else []
        return subprocess.run([*launcher, RHEXIS, *arguments], cwd=self.path, capture_output=True, text=True, timeout=300,
                              stdin=subprocess.DEVNULL, check=False)

    def run_well(self, *arguments, ranks=None):
        result = self.rhexis("run", *arguments, ranks=ranks)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def record(self, folder):
        return json.loads((self.path / folder / "run.json").read_text())

    def assert_refused(self, result, fragments, name, files):
        self.assertEqual(result.returncode, 2, f"{name}: {result.stderr}")
        self.assertEqual(result.stderr.count("rhexis: "), 1, f"{name}: not one message: {result.stderr}")
        for fragment in fragments:
            self.assertIn(fragment, result.stderr, name)
        self.assertEqual(sorted(os.listdir(self.path)), sorted(files), f"{name}: something was written")

    def test_wrong_inputs(self):
        for name, text, fragments in WRONG:
            with self.subTest(name):
                self.write("n.toml", text)
                self.assert_refused(self.rhexis("run", "n.toml"), ["n.toml", *fragments], name, ["n.toml"])
        self.write("n.toml", WRONG[-8][1])
        self.assert_refused(self.rhexis("run", "n.toml", ranks=3), WRONG[-8][2], "three ranks", ["n.toml"])

    def test_wrong_files(self):
        self.write("n.toml", FILES)
        files = ["n.toml", "j.csv", "v.csv"]
        for name, junctions, vessels, fragments in WRONG_FILES:
            self.write("j.csv", junctions)
            self.write("v.csv", vessels)
            for more, ranks in (([], None), ([], 2), (["--set", "network.tier=distributed"], 2)):
                with self.subTest(name, ranks=ranks, more=more):
                    self.assert_refused(self.rhexis("run", "n.toml", *more, ranks=ranks), fragments, name, files)
        self.write("v.csv", VESSELS)
        for tier in ("explicit", "distributed"):
            result = self.rhexis("run", "n.toml", "--set", "network.query=['9']", "--set", f"network.tier={tier}", ranks=2)
            self.assert_refused(result, ["no vessel '9'"], f"query, {tier}", files)
        for key, value in (("flow.inlet_pressure", "100 mmHg"), ("tree.generations", "4")):
            result = self.rhexis("run", "n.toml", "--set", f"{key}={value}")
            self.assert_refused(result, [key, value, "the files say it"], key, files)
        # More loops than series and parallel vessels make.
        self.write("v.csv", VESSELS + "3,a,c,9\n4,d,b,9\n5,d,c,9\n6,b,e,9\n7,e,c,9\n8,e,f,9\n9,f,b,9\n10,f,c,9\n")
        self.write("j.csv", JUNCTIONS + "d,1,1,1,20\ne,2,2,2,\nf,3,2,2,\n")
        result = self.rhexis("run", "n.toml", "--set", "network.solver=elimination")
        self.assert_refused(result, ["'elimination' leaves", "'auto'"], "elimination", files)
        self.write("v.csv", VESSELS)
        os.remove(self.path / "j.csv")
        self.assert_refused(self.rhexis("run", "n.toml"), ["network.files", "j.csv"], "absent file", ["n.toml", "v.csv"])

    def test_tiers_and_ranks_agree(self):
        self.write("n.toml", TREE)
        self.run_well("n.toml", "-o", "one")
        one = self.record("one")["results"]["network"]
        self.assertEqual((one["vessels"], one["junctions"], one["solver"]), (8190, 6144, "recursion"))
        self.assertLess(one["max_imbalance"], 1e-14)
        self.run_well("n.toml", "-o", "two", ranks=2)
        self.assertEqual(self.record("two")["results"]["network"], one)  # to the last bit
        for name in ("generations.csv", "histograms.csv"):
            self.assertEqual((self.path / "one" / name).read_text(), (self.path / "two" / name).read_text())
        for tier, ranks in (("explicit", None), ("explicit", 2), ("distributed", None), ("distributed", 3)):
            self.run_well("n.toml", "-o", "other", "--set", f"network.tier={tier}", ranks=ranks)
            other = self.record("other")["results"]["network"]
            for key in ("vessels", "junctions"):
                self.assertEqual(other[key], one[key], (tier, key))
            for key in ("inflow_m3_s", "volume_m3", "surface_m2"):
                self.assertAlmostEqual(other[key] / one[key], 1, delta=1e-11, msg=(tier, key))
            for a, b in zip(one["queries"], other["queries"], strict=True):
                self.assertEqual((a["name"], a["vessel"], a["kind"]), (b["name"], b["vessel"], b["kind"]))
                self.assertAlmostEqual(a["flow_m3_s"] / b["flow_m3_s"], 1, delta=1e-10)
                self.assertAlmostEqual(a["pressure_from_Pa"], b["pressure_from_Pa"], delta=1e-6)

    def test_ranks_without_vessels_and_answers_for_all(self):
        """More ranks than vessels, without coordinates, too; a query is answered alike whoever has the vessel."""
        self.write("n.toml", FILES)
        self.write("j.csv", JUNCTIONS)
        self.write("v.csv", VESSELS)
        keys = ["--set", "network.query=['2']", "--set", "weakness.strength_spread=0.2"]
        queries = []
        for tier, ranks in (("explicit", None), ("distributed", 1), ("distributed", 2), ("distributed", 3)):
            self.run_well("n.toml", "-o", "out", *keys, "--set", f"network.tier={tier}", ranks=ranks)
            queries.append(self.record("out")["results"]["network"]["queries"][0])
        self.assertNotEqual(queries[0]["strength_factor"], 1)
        self.assertEqual(queries[0]["end_m"], [0.003, 0.004, 0.012])
        for other in queries[1:]:
            for key in ("name", "vessel", "radius_m", "strength_factor", "start_m", "end_m"):
                self.assertEqual(other[key], queries[0][key], key)
        self.write("n.toml", TREE)
        strengths = set()
        for tier, ranks in (("implicit", None), ("explicit", None), ("distributed", 2)):
            self.run_well("n.toml", "-o", "tree", *keys[2:], "--set", f"network.tier={tier}", ranks=ranks)
            strengths.add(tuple(q["strength_factor"] for q in self.record("tree")["results"]["network"]["queries"]))
        self.assertEqual(len(strengths), 1, strengths)
        self.assertNotIn(1, strengths.pop())
        self.write("n.toml", FILES)
        self.write("j.csv", "id,pressure [mmHg]\na,10\nb,\nc,0\n")
        self.write("v.csv", "id,from,to,radius [um],length [mm]\n1,a,b,50,5\n2,b,c,40,12\n")
        for ranks in (2, 3):
            self.run_well("n.toml", "-o", "bare", "--set", "network.tier=distributed", ranks=ranks)
            self.assertEqual(self.record("bare")["results"]["network"]["vessels"], 2)

    def test_statistics_count_every_vessel(self):
        self.write("n.toml", TREE)
        self.run_well("n.toml", "-o", "out")
        with open(self.path / "out/generations.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 24)
        inflow = self.record("out")["results"]["network"]["inflow_m3_s"]
        for row in rows:
            self.assertAlmostEqual(float(row["mean_flow_m3_s"]) * int(row["vessels"]) / inflow, 1, delta=1e-12)
        with open(self.path / "out/histograms.csv", encoding="utf-8") as file:
            counts = {}
            for row in csv.DictReader(file):
                self.assertLess(float(row["from"]), float(row["to"]))
                key = (row["generation"], row["kind"], row["quantity"])
                counts[key] = counts.get(key, 0) + int(row["vessels"])
        self.assertEqual(len(counts), 12 * 5)
        for (generation, _, _), count in counts.items():
            self.assertEqual(count, 2 ** int(generation))

    def test_stored_lines(self):
        import h5py

        self.write("n.toml", TREE)
        self.run_well("n.toml", "-o", "out")
        with h5py.File(self.path / "out/network.h5") as file:
            lines = file["connectivity"][:]
            position, pressure = file["position"][:], file["pressure/000000"][:]
            flow, kind = file["flow/000000"][:], file["kind/000000"][:]
        self.assertEqual(len(lines), 300)
        self.assertEqual(sorted(set(kind)), [0, 1])
        self.assertTrue((flow > 0).all())
        self.assertTrue((pressure[lines[:, 0]] >= pressure[lines[:, 1]]).all())  # blood runs downhill along every line
        self.assertTrue((position[lines[kind == 0], 0] <= 0).all() and (position[lines[kind == 1], 0] >= 0).all())

    def test_stored_lines_of_all_ranks_name_their_vessels(self):
        import h5py

        self.write("n.toml", TREE)
        seen = []
        for tier, ranks in (("explicit", None), ("distributed", 2)):
            self.run_well("n.toml", "-o", tier, "--set", f"network.tier={tier}", "--set", "network.shown_vessels=10000",
                          ranks=ranks)
            with h5py.File(self.path / tier / "network.h5") as file:
                vessel, radius = file["vessel/000000"][:], file["radius/000000"][:]
            self.assertEqual(len(set(vessel)), len(vessel))
            seen.append(dict(zip(vessel, radius)))
        self.assertEqual(*seen)

    def test_gravity_adds_the_weight_of_blood_and_leaves_flow_alone(self):
        self.write("j.csv", JUNCTIONS)
        self.write("v.csv", VESSELS)
        self.write("n.toml", FILES + 'query = ["1", "2"]\n')
        self.run_well("n.toml", "-o", "still")
        # Along z only the second vessel rises, by 12 mm; the lower condition is given at its own height.
        self.run_well("n.toml", "-o", "up", "--set", "flow.acceleration=['0 m/s2', '0 m/s2', '-9.81 m/s2']",
                      "--set", "blood.density=1000 kg/m3")
        weight = 1000 * 9.81 * 12e-3
        still, up = (self.record(f)["results"]["network"] for f in ("still", "up"))
        drop = 10 * 133.322387415
        self.assertAlmostEqual(up["inflow_m3_s"] / still["inflow_m3_s"], (drop - weight) / drop, delta=1e-9)
        self.assertAlmostEqual(up["queries"][1]["pressure_to_Pa"], 0, delta=1e-6)
        self.assertAlmostEqual(up["queries"][0]["pressure_from_Pa"], drop, delta=1e-6)

    def test_published_circle_of_willis(self):
        self.run_well(os.path.join(SOURCE, "inputs/circle_of_willis.toml"), "-o", "out", "--set", "insitu.enabled=false")
        network = self.record("out")["results"]["network"]
        self.assertEqual((network["vessels"], network["junctions"]), (33, 30))
        self.assertLess(network["max_imbalance"], 1e-10)
        with open(self.path / "out/vessels.csv", encoding="utf-8") as file:
            flow = {row["vessel"]: float(row["flow_m3_s"]) for row in csv.DictReader(file)}
        # What enters the circle leaves it through its six arteries to the brain.
        inflow = sum(flow[v] for v in ("left internal carotid I", "right internal carotid I", "basilar"))
        out = sum(flow[f"{side} {v}"] for side in ("left", "right")
                  for v in ("middle cerebral", "anterior cerebral A2", "posterior cerebral P2"))
        self.assertAlmostEqual(inflow / out, 1, delta=1e-9)
        self.assertLess(abs(flow["anterior communicating"]), 0.1 * flow["left middle cerebral"])

    def test_phase_separation_gives_every_vessel_its_haematocrit(self):
        self.run_well(os.path.join(SOURCE, "inputs/own_network.toml"), "-o", "out", "--set", "insitu.enabled=false")
        with open(self.path / "out/vessels.csv", encoding="utf-8") as file:
            rows = {row["vessel"]: row for row in csv.DictReader(file)}
        haematocrits = [float(row["haematocrit"]) for row in rows.values()]
        self.assertLess(min(haematocrits), 0.3)
        self.assertGreater(max(haematocrits), 0.45)
        self.assertAlmostEqual(float(rows["venule"]["haematocrit"]), 0.4, delta=1e-9)
        result = self.run_well(os.path.join(SOURCE, "inputs/own_network.toml"), "-o", "short", "--set", "insitu.enabled=false",
                               "--set", "blood.phase_iterations=3")
        self.assertIn("not converged", result.stderr)

    def test_check(self):
        self.write("n.toml", TREE)
        result = self.rhexis("check", "n.toml")
        self.assertEqual(result.returncode, 0, result.stderr)
        for text in ("8,190", "2 mm", "memory", "time"):
            self.assertIn(text, result.stdout)
        self.assertEqual(os.listdir(self.path), ["n.toml"])
        result = self.rhexis("check", "n.toml", "--set", "network.tier=distributed", "--set", "tree.generations=40")
        self.assert_refused(result, ["network.tier", "GB", "implicit"], "check of a tree that fits no machine", ["n.toml"])

    def test_trees_of_one_generation_on_several_ranks(self):
        self.write("n.toml", tree("generations", "generations = 1").replace('query = ["artery.", "vein.0110", "4095"]', "")
                   .replace("[network]", '[network]\ntier = "distributed"'))
        flows = []
        for ranks in (1, 2, 3):
            self.run_well("n.toml", "-o", "out", ranks=ranks)
            flows.append(self.record("out")["results"]["network"]["inflow_m3_s"])
        self.assertEqual(flows, [flows[0]] * 3)

    def test_junctions_without_vessels_count(self):
        self.write("n.toml", FILES)
        self.write("v.csv", VESSELS)
        self.write("j.csv", JUNCTIONS + "d,9,9,9,\n")
        for tier, ranks in (("explicit", None), ("distributed", 2)):
            self.run_well("n.toml", "-o", "out", "--set", f"network.tier={tier}", ranks=ranks)
            self.assertEqual(self.record("out")["results"]["network"]["junctions"], 4)

    def test_networks_without_places_are_not_drawn(self):
        self.write("n.toml", FILES)
        self.write("v.csv", "id,from,to,radius [um],length [mm]\n1,a,b,50,5\n2,b,c,40,12\n")
        self.write("j.csv", "id,pressure [mmHg]\na,10\nb,\nc,0\n")
        for more, ranks in (([], None), (["--set", "network.tier=distributed"], 2)):
            result = self.run_well("n.toml", "-o", "out", "--set", f"insitu.scripts=['{SOURCE}/catalyst_scripts/network.py']", *more, ranks=ranks)
            self.assertIn("no coordinates", result.stderr)
            self.assertEqual(self.record("out")["status"], "completed")

    def test_histograms_say_what_they_hold(self):
        self.write("n.toml", tree("outlet_pressure", 'outlet_pressure = "-20 mmHg"'))
        result = self.run_well("n.toml", "-o", "out")
        self.assertIn("real ones would collapse", result.stderr)
        with open(self.path / "out/histograms.csv", encoding="utf-8") as file:
            edges = [row["from"] for row in csv.DictReader(file) if (row["kind"], row["quantity"]) == ("vein", "hoop_stress_Pa")]
        self.assertIn("-inf", edges)

    def test_conditions_of_the_input_and_what_is_left_out(self):
        self.write("j.csv", JUNCTIONS + "d,9,9,9,\ne,9,9,8,\n")
        self.write("v.csv", VESSELS + "3,d,e,50\n4,b,b,50\n")
        self.write("n.toml", FILES + 'drop = ["self_loops", "islands"]\n'
                   '[[condition]]\njunction = "a"\npressure = "20 mmHg"\n'
                   '[[condition]]\nnearest = ["3 mm", "4 mm", "13 mm"]\nflow = "-1e-3 mL/min"\n')
        result = self.run_well("n.toml", "-o", "out")
        network = self.record("out")["results"]["network"]
        self.assertEqual((network["vessels"], network["junctions"]), (2, 3))
        self.assertAlmostEqual(network["inflow_m3_s"] / (1e-9 / 60), 1, delta=1e-12)
        self.assertAlmostEqual(network["highest_pressure_Pa"], 20 * 133.322387415, delta=1e-6)
        self.assertIn("condition[2] is at junction c", result.stdout)
        for more, fragments in (
                (["condition[1].junction=q"], ["condition[1].junction=q", "no junction of this id or name"]),
                (["condition[2].haematocrit=45"], ["condition[2].haematocrit", "at most 0.95"]),
                (["network.drop=['loops']"], ["network.drop", "self_loops"])):
            result = self.rhexis("run", "n.toml", "--set", *more)
            self.assert_refused(result, fragments, more[0], ["n.toml", "j.csv", "v.csv", "out"])

    def test_flows_that_mean_little_are_told(self):
        self.write("n.toml", FILES)
        self.write("v.csv", VESSELS)
        self.write("j.csv", JUNCTIONS)
        self.assertIn("2 vessels, 3 junctions", self.rhexis("check", "n.toml").stdout)
        for junctions, vessels, warning in (
                (JUNCTIONS.replace("12,0", "12,"), VESSELS, "nothing flows: no difference"),
                (JUNCTIONS, VESSELS.replace("50", "2").replace("40", "2").replace("[um]", "[mm]"), "the Reynolds number reaches"),
                (JUNCTIONS, VESSELS.replace("[um]", "[mm]"), "an inflow of"),
                (JUNCTIONS, VESSELS.replace("[um]", "[mm]"), str(self.path / "v.csv") + ":2: vessel 1, the first of 2: radius 50 mm"),
                (JUNCTIONS.replace("12,0", "12,-20"), VESSELS, "the pressure falls to -20 mmHg"),
                (JUNCTIONS.replace("12,0", "12,-1000"), VESSELS, "the pressure falls to -1000 mmHg, below vacuum"),
                (JUNCTIONS, VESSELS, None)):
            self.write("j.csv", junctions)
            self.write("v.csv", vessels)
            for more, ranks in (([], None), (["--set", "network.tier=distributed"], 2)):
                result = self.run_well("n.toml", "-o", "out", *more, ranks=ranks)
                record = self.record("out")
                told = [w for w in record["warnings"] if warning and w.startswith(warning)]
                self.assertEqual(len(told), 1 if warning else 0, record["warnings"])
                self.assertTrue(warning or not record["warnings"], record["warnings"])
                self.assertEqual(result.stderr.count("rhexis: warning: "), len(record["warnings"]), result.stderr)
                if warning and "Reynolds" in warning:
                    self.assertGreater(record["results"]["network"]["highest_reynolds"], 2300)

    def test_a_page_about_a_network(self):
        self.write("n.toml", FILES)
        self.write("j.csv", JUNCTIONS + "d,0,0,1,\n")
        self.write("v.csv", VESSELS.replace("2,b,c,40", "2,b,c,40\n3,b,d,30"))
        pages = [self.rhexis("network", *files) for files in (("j.csv", "v.csv"), ("n.toml",))]
        for page in pages:
            self.assertEqual(page.returncode, 0, page.stderr)
            for part in ("vessels     3", "junctions   4", "3 ends, 2 conditions", "no flow     in 1 of 3 vessels", "radii of the vessels", "####", "can be solved"):
                self.assertIn(part, page.stdout)
            self.assertIn("no condition, so that nothing flows there: d", page.stderr)
        # What is written can be read again, gives the same flow, and is not written over another file.
        self.assertEqual(self.rhexis("network", "j.csv", "v.csv", "-o", "clean.json").returncode, 0)
        self.run_well("n.toml", "-o", "first")
        self.run_well("n.toml", "--set", "network.files=['clean.json']", "-o", "again")
        first, again = ((self.path / folder / "vessels.csv").read_text() for folder in ("first", "again"))
        self.assertEqual(first, again)
        for arguments, message in ((("j.csv", "v.csv", "-o", "clean.json"), "--overwrite"), (("clean.json", "-o", "clean.json", "--overwrite"), "is read from this file"),
                                   (("j.csv", "v.csv", "-o", "clean.txt"), ".json or .vtp"), (("j.csv",), "two .csv files"), (("gone.json",), "gone.json"),
                                   (("x.vtp",), "--length-unit mm")):
            result = self.rhexis("network", *arguments)
            self.assertEqual(result.returncode, 2, message)
            self.assertIn(message, result.stderr)
        self.assertEqual(self.rhexis("network", "j.csv", "v.csv", "-o", "clean.json", "--overwrite").returncode, 0)

    def test_vtp_files_without_paraview_are_refused_at_once(self):
        self.write("n.toml", TREE)
        for command in ("check", "run"):
            result = subprocess.run([RHEXIS, command, "n.toml", "--set", "network.vtp=true"], cwd=self.path, capture_output=True, text=True,
                                    env={**os.environ, "RHEXIS_PLUGIN_DIR": "/none"}, timeout=60, check=False)
            self.assert_refused(result, ["network.vtp=true", "ParaView"], command, ["n.toml"])

    def test_restart_is_for_vessels(self):
        self.write("n.toml", TREE)
        self.assert_refused(self.rhexis("run", "n.toml", "--restart", "x.h5"), ["--restart"], "restart", ["n.toml"])

    def test_interrupt_is_recorded(self):
        self.write("n.toml", tree("generations", "generations = 33"))
        with subprocess.Popen([RHEXIS, "run", "n.toml", "-o", "out"], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            seen = ""
            while "network" not in seen:  # the header's
                seen = process.stdout.readline()
            time.sleep(0.5)
            process.send_signal(signal.SIGINT)
            _, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, error)
        record = self.record("out")
        self.assertEqual((record["status"], record["input"]["tree"]["generations"]["value"]), ("failed: interrupted by SIGINT", 33))

    def test_solver_that_does_not_reach_its_aim_is_status_3(self):
        result = self.rhexis("run", os.path.join(SOURCE, "inputs/circle_of_willis.toml"), "-o", "out", "--set", "insitu.enabled=false",
                             "--set", "network.solver=jacobi", "--set", "network.max_iterations=1")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertTrue(self.record("out")["status"].startswith("failed: "))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
