# SPDX-License-Identifier: BSD-3-Clause
"""Screening, weak walls and cascades, as a user meets them: lists, records, choice of the vessel, wrong input, ranks.

Run by ctest as: test_screening.py RHEXIS SOURCE_DIR MPIRUN...
"""

import csv
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

RHEXIS, SOURCE, *MPIRUN = sys.argv[1:]
MMHG = 133.322387415

TREE = """\
[scene]
model = "network"
[tree]
generations = 12
root_radius = "2 mm"
asymmetry = 0.9
least_asymmetry = 0.4
length_spread = 0.2
[wall]
artery_rule = "radius"
[flow]
inlet_pressure = "90 mmHg"
outlet_pressure = "5 mmHg"
[network]
shown_vessels = 10
[screening]
top = 25
critical_stretch = 0.05
[weakness]
vessels = ["artery.0110100"]
subtrees = ["vein.01101"]
strength = 0.2
thickness = 0.8
strength_spread = 0.1
thickness_spread = 0.1
seed = 3
"""

# Arteries beside each other behind one feeder; each with a bed of its own.
JUNCTIONS = "id,x [mm],y [mm],z [mm],pressure [mmHg]\nheart,-60,0,0,215\nneck,0,0,0,\na,9,6,0,\nb,9,0,0,\nc,9,-6,0,\nvein,70,0,0,5\n"
VESSELS = """\
id,from,to,radius [mm],length [mm],wall_thickness [mm]
feeder,heart,neck,0.7,600,1.2
a,neck,a,1.5,6,0.42
b,neck,b,1.5,6,0.46
c,neck,c,1.5,6,0.9
bed a,a,vein,0.25,60,0.2
bed b,b,vein,0.25,60,0.2
bed c,c,vein,0.25,60,0.2
"""
FILES = """\
[scene]
model = "coupled"
[network]
source = "file"
files = ["j.csv", "v.csv"]
[coupling]
vessel = "screening"
[material]
density = "1.3 g/cm3"
young_modulus = "3.5 MPa"
critical_stretch = 0.02
[discretisation]
cross_section = "lattice"
spacing = "200 um"
[load]
layer = "consistent"
schedule = "smooth_ramp"
ramp_time = "2 ms"
[time]
end = "2.5 ms"
[output]
every_steps = 200
movie = false
"""

WRONG = [
    ("distributed tier", TREE.replace("[network]", '[network]\ntier = "distributed"'), ["screening.top", "implicit"]),
    ("absent weak vessel", TREE.replace("0110100", "0112"), ["weakness.vessels", "0 and 1"]),
    ("absent weak subtree", TREE.replace("vein.01101", "vein.011011011011011"), ["weakness.subtrees", "11 steps"]),
    ("no strength", TREE.replace("strength = 0.2", "strength = 0"), ["weakness.strength", "greater than 0"]),
    ("spread of more than one", TREE.replace("strength_spread = 0.1", "strength_spread = 2"), ["weakness.strength_spread", "at most 1"]),
    ("too long a list", TREE.replace("top = 25", "top = 20000"), ["screening.top", "10000"]),
    ("two critical stretches", FILES + "[screening]\ncritical_stretch = 0.1\n", ["screening.critical_stretch"]),
    ("subtrees in a file", FILES + '[weakness]\nsubtrees = ["artery."]\n', ["weakness.subtrees", "tree"]),
    ("weak vessel that the file lacks", FILES + '[weakness]\nvessels = ["d"]\n', ["weakness.vessels", "'d'", "v.csv"]),
    ("cascade in an implicit tree", TREE.replace('"network"', '"coupled"').replace("critical_stretch = 0.05\n", "")
     + '[coupling]\nvessel = "screening"\n[cascade]\nevents = 3\n[time]\nend = "1 ms"\n[material]\ncritical_stretch = 0.05\n',
     ["cascade.events", "explicit"]),
    ("negative pressure at the one at risk", FILES + '[body]\ncompression = "400 mmHg"\n', ["coupling.vessel", "tension"]),
]


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def stress_factor(relative_thickness):
    square = (1 + relative_thickness) ** 2
    return (square + 1) / (square - 1)


class Screening(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        (self.path / "j.csv").write_text(JUNCTIONS)
        (self.path / "v.csv").write_text(VESSELS)

    def run_scene(self, text, name="out", ranks=1, threads=1, sets=(), more=(), status=0):
        scene = self.path / f"{name}.toml"
        scene.write_text(text)
        command = ([*MPIRUN, "-n", str(ranks)] if ranks > 1 else []) + [RHEXIS, "run", scene, "-o", self.path / name]
        for entry in sets:
            command += ["--set", entry]
        command += more
        environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "OMP_WAIT_POLICY": "passive"}
        done = subprocess.run(command, capture_output=True, text=True, cwd=self.path, env=environment)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def record(self, name="out"):
        return json.loads((self.path / name / "run.json").read_text())["results"]

    def test_wrong_input(self):
        for name, text, parts in WRONG:
            for ranks in (1, 2) if name in ("absent weak vessel", "weak vessel that the file lacks") else (1,):
                with self.subTest(name, ranks=ranks):
                    done = self.run_scene(text, "wrong", ranks, status=2)
                    self.assertEqual(done.stderr.count("rhexis:"), 1, done.stderr)
                    for part in parts:
                        self.assertIn(part, done.stderr)
                    self.assertFalse((self.path / "wrong").exists())

    def test_tiers_ranks_and_threads_agree(self):
        self.run_scene(TREE, "one")
        self.run_scene(TREE, "shared", ranks=3, threads=2)
        self.run_scene(TREE, "explicit", sets=['network.tier="explicit"'])
        for file in ("screening.csv", "risk_histograms.csv"):
            self.assertEqual((self.path / "one" / file).read_bytes(), (self.path / "shared" / file).read_bytes())
        one, explicit = rows(self.path / "one" / "screening.csv"), rows(self.path / "explicit" / "screening.csv")
        self.assertEqual([r["vessel"] for r in one], [r["vessel"] for r in explicit])
        for a, b in zip(one, explicit):
            self.assertAlmostEqual(float(a["risk"]) / float(b["risk"]), 1, places=10)
            self.assertEqual(a["strength_factor"], b["strength_factor"])
        self.assertEqual((self.path / "one" / "risk_histograms.csv").read_text(),
                         (self.path / "explicit" / "risk_histograms.csv").read_text())
        self.assertEqual(self.record("one")["network"]["screening"]["vessels"], 2 * (2**12 - 1))

    def test_the_weak_vessel_comes_first(self):
        self.run_scene(TREE, sets=["weakness.subtrees=[]"])
        top = self.record()["network"]["screening"]["top"]
        self.assertEqual(top[0]["name"], "artery.0110100")
        self.assertEqual(rows(self.path / "out" / "screening.csv")[0]["vessel"], "artery.0110100")

    def test_risk_of_a_file_is_the_closed_form(self):
        text = FILES + '[screening]\ntop = 7\n[weakness]\nvessels = ["b"]\nstrength = 0.5\nthickness = 0.9\n'
        self.run_scene(text, sets=['time.end="0.02 ms"'])
        found = rows(self.path / "out" / "screening.csv")
        self.assertEqual(len(found), 7)
        self.assertEqual(found[0]["vessel"], "b")
        self.assertEqual({row["wall"] for row in found}, {"given"})
        for row in found:
            pressure = 0.5 * (float(row["pressure_from_Pa"]) + float(row["pressure_to_Pa"]))
            strain = pressure * (stress_factor(float(row["wall_thickness_m"]) / float(row["radius_m"])) + 0.25) / 3.5e6
            self.assertAlmostEqual(float(row["risk"]) / (strain / (0.02 * float(row["strength_factor"]))), 1, places=12)
        # The chosen vessel's wall is the weak one: thinner, and it breaks at half the stretch.
        chosen = self.record()["coupling"]["vessel"]
        self.assertEqual((chosen["name"], chosen["strength_factor"]), ("b", 0.5))
        self.assertAlmostEqual(chosen["wall_thickness_m"], 0.9 * 0.46e-3, delta=1e-15)

    def test_a_weak_wall_is_the_wall_of_that_strength(self):
        weak = FILES.replace('"screening"', '"b"') + '[weakness]\nvessels = ["b"]\nstrength = 0.75\n'
        self.run_scene(weak, "weak")
        self.run_scene(FILES.replace('"screening"', '"b"'), "thin", sets=["material.critical_stretch=0.015"])
        self.assertEqual((self.path / "weak" / "history.csv").read_text(), (self.path / "thin" / "history.csv").read_text())
        self.assertIsNotNone(self.record("weak")["rupture_onset_s"])

    def closed_form(self, open_beds):
        """Inflow with that many arteries open, by Eq. (9)."""
        resistance = lambda radius, length: 8 * 1e-3 * self.viscosity * length / (math.pi * radius**4)
        one = resistance(1.5e-3, 6e-3) + resistance(0.25e-3, 60e-3)
        return 210 * MMHG / (resistance(0.7e-3, 0.6) + one / open_beds)

    def test_cascade_by_occlusion(self):
        text = FILES + '[cascade]\nevents = 5\noutcome = "occlusion"\n[blood]\nviscosity_law = "constant"\nviscosity = "4 mPa s"\n'
        self.viscosity = 4
        self.run_scene(text)
        self.run_scene(text, "shared", ranks=2)
        events = rows(self.path / "out" / "cascade.csv")
        self.assertEqual((self.path / "out" / "cascade.csv").read_text(), (self.path / "shared" / "cascade.csv").read_text())
        # a and b tear, one after the other; c is thick enough.
        self.assertEqual([e["name"] for e in events], ["a", "b"])
        self.assertEqual([e["next_vessel"] for e in events], ["b", "c"])
        self.assertTrue(all(e["ruptured"] == "true" for e in events))
        self.assertLess(float(events[0]["time_s"]), float(events[1]["time_s"]))
        self.assertLess(float(events[1]["next_risk"]), 1)
        for event, before in zip(events, (3, 2)):
            self.assertAlmostEqual(float(event["inflow_before_m3_s"]) / self.closed_form(before), 1, places=7)
            self.assertAlmostEqual(float(event["inflow_after_m3_s"]) / self.closed_form(before - 1), 1, places=7)
        record = self.record()
        self.assertEqual(len(record["cascade"]), 2)
        self.assertTrue((self.path / "out" / "event_02" / "history.csv").exists())
        self.assertEqual(json.loads((self.path / "out" / "run.json").read_text())["status"], "completed")

    def test_cascade_by_bleeding(self):
        text = FILES + "[cascade]\nevents = 5\n"
        self.run_scene(text)
        (event,) = rows(self.path / "out" / "cascade.csv")
        # The leak relieves the others.
        self.assertEqual((event["name"], event["ruptured"]), ("a", "true"))
        self.assertLess(float(event["next_risk"]), 1)
        leak, opening = float(event["leak_m3_s"]), float(event["opening_m2"])
        flow = {r["vessel"]: r for r in rows(self.path / "out" / "vessels.csv")}
        # Blood is conserved: what is lost on the way leaks.
        out = sum(float(flow[f"bed {name}"]["flow_m3_s"]) for name in "abc")
        self.assertAlmostEqual((float(flow["feeder"]["flow_m3_s"]) - out) / leak, 1, places=8)
        self.assertGreater(leak, 0.1 * float(event["inflow_before_m3_s"]))
        # The orifice law, with the pressure half way along the vessel from both ends' flows.
        a = flow["a"]
        lost = float(a["pressure_from_Pa"]) - float(a["pressure_to_Pa"])
        into, out_of = float(a["flow_m3_s"]), float(flow["bed a"]["flow_m3_s"])
        middle = float(a["pressure_from_Pa"]) - lost * into / (into + out_of)
        given = json.loads((self.path / "out" / "run.json").read_text())["input"]
        coefficient, density = given["load"]["discharge_coefficient"]["value"], given["blood"]["density"]["value"]
        self.assertAlmostEqual(leak / (coefficient * opening * math.sqrt(2 * middle / density)), 1, places=5)

    def test_a_cascade_goes_on_from_any_checkpoint(self):
        """Within its second event, two-way, on two ranks; between events; bit by bit."""
        text = FILES.replace('"screening"', '"screening"\nmode = "two_way"\nwindow = "50 us"')
        text += '[cascade]\nevents = 3\nrisk_limit = 0.5\noutcome = "occlusion"\n'
        self.run_scene(text, "whole", sets=["output.checkpoint_every=150"])
        whole = self.record("whole")
        events = rows(self.path / "whole/cascade.csv")
        self.assertEqual([e["name"] for e in events], ["a", "b", "c"])
        steps = sorted(path.name for path in (self.path / "whole/event_02/checkpoints").iterdir())
        self.assertGreater(len(steps), 2)
        for name, checkpoint, ranks in (("within", f"event_02/checkpoints/{steps[1]}", 2), ("between", "checkpoints/event_01.h5", 1)):
            with self.subTest(name):
                shutil.copytree(self.path / "whole", self.path / name)
                first = (self.path / name / "event_01/run.json").stat().st_mtime_ns
                self.run_scene(text, name, ranks=ranks, more=["--restart", self.path / name / checkpoint])
                self.assertEqual(first, (self.path / name / "event_01/run.json").stat().st_mtime_ns)
                self.assertEqual(self.record(name)["cascade"], whole["cascade"])
                self.assertEqual(self.record(name)["network"], whole["network"])
                for file in ("cascade.csv", *(f"event_0{event}/{table}.csv" for event in (1, 2, 3) for table in ("history", "coupling"))):
                    self.assertEqual((self.path / name / file).read_bytes(), (self.path / "whole" / file).read_bytes(), file)
        # Fewer events: what came after goes.
        self.run_scene(text, "between", sets=["cascade.events=2"], more=["--restart", self.path / "between/checkpoints/event_01.h5"])
        self.assertEqual([e["name"] for e in rows(self.path / "between/cascade.csv")], ["a", "b"])
        self.assertFalse((self.path / "between/event_03/history.csv").exists())
        self.assertTrue((self.path / "between/event_01/history.csv").exists())
        # Another network, no cascade, or fewer events than the checkpoint has seen.
        within, between = f"whole/event_02/checkpoints/{steps[1]}", "whole/checkpoints/event_01.h5"
        (self.path / "wide.csv").write_text(VESSELS.replace("bed c,c,vein,0.25", "bed c,c,vein,0.26"))
        for checkpoint, setting, what in ((between, "network.files=['j.csv','wide.csv']", "the network is not as it was: after event 1 its inflow was"),
                                          (within, "network.files=['j.csv','wide.csv']", "the network is not as it was: after event 1 its inflow was"),
                                          (within, "cascade.events=1", "of event 2, but cascade.events = 1"),
                                          (between, "material.critical_stretch=0.03", "another body"),
                                          (between, "cascade.events=0", "between two events"), (within, "cascade.events=0", "set cascade.events")):
            with self.subTest(what):
                done = self.run_scene(text, "x", sets=[setting], more=["--restart", checkpoint], status=2)
                self.assertIn(checkpoint, done.stderr)
                self.assertIn(what, done.stderr)
                self.assertFalse((self.path / "x").exists())

    def test_an_interrupted_cascade_loses_nothing(self):
        text = FILES.replace("every_steps = 200", "every_steps = 2") + '[cascade]\nevents = 2\noutcome = "occlusion"\n'
        self.run_scene(text, "whole")
        history = self.path / "cut/event_02/history.csv"
        with subprocess.Popen([RHEXIS, "run", "whole.toml", "-o", "cut"], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            while process.poll() is None and not (history.exists() and history.read_text().count("\n") > 3):
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130)
        (checkpoint,) = (self.path / "cut/event_02/checkpoints").iterdir()
        self.run_scene(text, "cut", more=["--restart", checkpoint])
        for file in ("cascade.csv", "event_02/history.csv"):
            self.assertEqual((self.path / "cut" / file).read_bytes(), (self.path / "whole" / file).read_bytes(), file)

    def test_a_cascade_that_cannot_go_on_keeps_what_it_has(self):
        """The second vessel is too short to be simulated."""
        (self.path / "j.csv").write_text(JUNCTIONS.replace("b,9,0,0", "b,0.3,0,0"))
        (self.path / "v.csv").write_text(VESSELS.replace("b,neck,b,1.5,6,0.46", "b,neck,b,1.5,0.3,0.42"))
        text = FILES.replace('"screening"', '"a"') + '[cascade]\nevents = 5\noutcome = "occlusion"\n'
        text = text.replace('spacing = "200 um"', "particles = 30000")
        done = self.run_scene(text, sets=['time.end="1.4 ms"', 'load.ramp_time="1.2 ms"'], status=3)
        self.assertIn("10 spacings", done.stderr)
        record = json.loads((self.path / "out" / "run.json").read_text())
        self.assertIn("10 spacings", record["status"])
        self.assertEqual([event["name"] for event in record["results"]["cascade"]], ["a"])
        self.assertTrue((self.path / "out" / "event_01" / "history.csv").exists())
        (event,) = rows(self.path / "out" / "cascade.csv")
        self.assertEqual((event["name"], event["ruptured"], event["next_vessel"]), ("a", "true", "b"))
        self.assertIn("event 2 cannot be simulated", record["status"])
        self.assertIsNotNone(record["results"]["network"]["vessels"])
        self.assertTrue((self.path / "out" / "vessels.csv").exists())
        # Nobody asks for that event.
        self.run_scene(text, sets=['time.end="1.4 ms"', 'load.ramp_time="1.2 ms"', "cascade.events=1"])
        (event,) = rows(self.path / "out" / "cascade.csv")
        self.assertEqual((event["name"], event["next_vessel"]), ("a", "b"))

    def test_a_cascade_without_a_vessel_at_risk(self):
        (self.path / "n.toml").write_text(FILES + "[cascade]\nevents = 2\nrisk_limit = 1000\n")
        done = subprocess.run([RHEXIS, "check", "n.toml"], cwd=self.path, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("No vessel's risk is above cascade.risk_limit = 1000", done.stdout)
        self.run_scene(FILES + "[cascade]\nevents = 2\nrisk_limit = 1000\n")
        self.assertEqual(self.record()["cascade"], [])

    def test_a_wall_that_holds_is_not_tried_again(self):
        # A limit far below one: screening sends vessels whose walls hold.
        text = FILES + "[cascade]\nevents = 2\nrisk_limit = 0.1\n"
        self.run_scene(text, sets=["material.critical_stretch=0.1"])
        events = rows(self.path / "out" / "cascade.csv")
        self.assertEqual([e["ruptured"] for e in events], ["false", "false"])
        self.assertEqual(len({e["name"] for e in events}), 2)
        self.assertEqual([e["time_s"] for e in events], ["", ""])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
