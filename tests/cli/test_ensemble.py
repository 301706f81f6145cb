# SPDX-License-Identifier: BSD-3-Clause
"""Ensembles as a user meets them: wrong input, the same digits on any ranks and threads, restarts, mixing of folders.

Run by ctest as: test_ensemble.py RHEXIS MPIRUN...
"""

import concurrent.futures
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

RHEXIS, *MPIRUN = sys.argv[1:]

# A short piece of a weak artery: 80 ms a sample.
ENSEMBLE = """\
[scene]
model = "ensemble"

[ensemble]
pressures = ["260 mmHg", "100 mmHg", "180 mmHg"]
samples = 6
strength_spread = 0.2
thickness_spread = 0.05
stiffness_spread = 0.1

[vessel]
inner_radius = "1.5 mm"
outer_radius = "2 mm"
length = "1.6 mm"

[material]
critical_stretch = 0.02

[discretisation]
spacing = "160 um"

[boundary]
ends = "axial_periodic"

[load]
schedule = "smooth_ramp"
ramp_time = "0.5 ms"

[time]
end = "0.6 ms"
"""


def ensemble(line_start, new):
    """The scene with the line that begins so replaced; the new text may be several lines, or none."""
    assert any(line.startswith(line_start) for line in ENSEMBLE.splitlines()), line_start
    return "\n".join(new if line.startswith(line_start) else line for line in ENSEMBLE.splitlines()) + "\n"


RANGE = 'lowest_pressure = "100 mmHg"\nhighest_pressure = "260 mmHg"\npressure_count = 3'

# name, input, what the message must contain
WRONG = [
    ("no pressures", ensemble("pressures", ""), ["ensemble.pressures", "lowest_pressure"]),
    ("both ways", ensemble("samples", RANGE), ["e.toml:5", "ensemble.pressures", "not both"]),
    ("half a range", ensemble("pressures", 'lowest_pressure = "1 kPa"'), ["ensemble.highest_pressure", "pressure_count"]),
    ("range upside down", ensemble("pressures", RANGE.replace("260", "90")), ["ensemble.highest_pressure", "above"]),
    ("one pressure in a range", ensemble("pressures", RANGE.replace("= 3", "= 1")), ["ensemble.pressure_count", "at least 2"]),
    ("pressure twice", ensemble("pressures", 'pressures = ["1 kPa", "1000 Pa"]'), ["ensemble.pressures", "twice"]),
    ("pressure without unit", ensemble("pressures", "pressures = [100]"), ["ensemble.pressures", "unit"]),
    ("no pressure at all", ensemble("pressures", 'pressures = ["0 mmHg"]'), ["ensemble.pressures", "greater than 0"]),
    ("no walls", ensemble("samples", "samples = 0"), ["ensemble.samples", "at least 1"]),
    ("half a wall", ensemble("samples", "samples = 2.5"), ["ensemble.samples", "whole"]),
    ("negative spread", ensemble("strength", "strength_spread = -0.1"), ["ensemble.strength_spread", "at least 0"]),
    ("walls thinner than a spacing", ensemble("thickness", "thickness_spread = 1"), ["ensemble.thickness_spread", "spacing"]),
    ("load.pressure", ensemble("schedule", 'pressure = "100 mmHg"'), ["load.pressure", "scene.model", "vessel"]),
    ("table", ensemble("schedule", 'schedule = "table"'), ["load.schedule", "smooth_ramp"]),
    ("venting", ensemble("schedule", 'venting = "none"'), ["load.venting", "scene.model", "vessel"]),
    ("time step", ensemble("end =", 'end = "1 ms"\nstep = "1 us"'), ["time.step", "scene.model", "vessel"]),
    ("output", ENSEMBLE + "[output]\nevery_steps = 2\n", ["[output]", "scene.model", "vessel"]),
    ("pictures", ENSEMBLE + "[insitu]\nenabled = false\n", ["[insitu]", "scene.model", "vessel"]),
    ("ensemble of another scene", ensemble("model", 'model = "vessel"'), ["[ensemble]", "scene.model", "ensemble"]),
    ("vessel inside out", ensemble("outer", 'outer_radius = "1 mm"'), ["vessel.outer_radius", "above"]),
]


class Ensemble(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="rhexis_ensemble_")
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        self.write(ENSEMBLE)

    def write(self, text):
        (self.path / "e.toml").write_text(text, encoding="utf-8")

    def rhexis(self, *arguments, ranks=None, threads=1, folder=None):
        launcher = [*MPIRUN, "-n", str(ranks)] if ranks else []
        # Programs that start and end at once make and remove each other's folder of MPI's sessions.
        with tempfile.TemporaryDirectory() as sessions:
            environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "OMPI_MCA_orte_tmpdir_base": sessions}
            return subprocess.run([*launcher, RHEXIS, *arguments], cwd=folder or self.path, capture_output=True, text=True,
                                  timeout=300, stdin=subprocess.DEVNULL, check=False, env=environment)

    def run_well(self, *arguments, **how):
        result = self.rhexis("run", "e.toml", *arguments, **how)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def text(self, name):
        return (self.path / name).read_text()

    def rows(self, name):
        with open(self.path / name, encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def assert_refused(self, result, fragments, name):
        self.assertEqual(result.returncode, 2, f"{name}: {result.stderr}")
        self.assertEqual(result.stderr.count("rhexis: "), 1, f"{name}: not one message: {result.stderr}")
        for fragment in fragments:
            self.assertIn(fragment, result.stderr, name)

    def test_wrong_inputs(self):
        def refusal(number):
            folder = self.path / str(number)
            folder.mkdir()
            (folder / "e.toml").write_text(WRONG[number][1], encoding="utf-8")
            return self.rhexis("run", "e.toml", folder=folder), os.listdir(folder)

        # A start of MPI is a second of waiting.
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            refusals = list(pool.map(refusal, range(len(WRONG))))
        for (name, _, fragments), (result, files) in zip(WRONG, refusals, strict=True):
            with self.subTest(name):
                self.assert_refused(result, ["e.toml", *fragments], name)
                self.assertEqual(files, ["e.toml"], f"{name}: something was written")
        for name, text, fragments in (WRONG[1], WRONG[11]):
            self.write(text)
            self.assert_refused(self.rhexis("run", "e.toml", ranks=2), fragments, f"{name}, two ranks")
        self.write(ENSEMBLE)
        self.assert_refused(self.rhexis("run", "e.toml", "--restart", "x.h5"), ["--restart", "same command"], "restart")
        self.assertFalse((self.path / "results").exists())

    def test_check(self):
        result = self.rhexis("check", "e.toml")
        self.assertEqual(result.returncode, 0, result.stderr)
        for text in ("18 = 6 walls x 3 pressures", "100 mmHg to 260 mmHg", "memory", "a sample"):
            self.assertIn(text, result.stdout)
        self.assertEqual(os.listdir(self.path), ["e.toml"])

    def test_ranks_threads_and_restarts_give_the_same_bytes(self):
        out = self.run_well("-o", "one").stdout
        self.assertIn("18 in all, 18 new", out)
        tables = {name: self.text(f"one/{name}") for name in ("samples.csv", "probability.csv")}

        def assert_same(folder, what):
            for name, table in tables.items():
                self.assertEqual(self.text(f"{folder}/{name}"), table, f"{what}: {name}")

        self.run_well("-o", "two", ranks=2)
        assert_same("two", "two ranks")
        self.run_well("-o", "threads", threads=2)
        assert_same("threads", "two threads")
        self.check_tables("one")

        # A crash: seven samples and a torn row are left.
        lines = tables["samples.csv"].splitlines(keepends=True)
        (self.path / "two/samples.csv").write_text("".join(lines[:8]) + lines[8][:-9])
        os.remove(self.path / "two/probability.csv")
        result = self.run_well("-o", "two", ranks=3)
        self.assertIn("18 in all, 11 new", result.stdout)
        assert_same("two", "restart")
        results = json.loads(self.text("two/run.json"))["results"]["ensemble"]
        self.assertEqual((results["samples"], results["samples_of_earlier_runs"], results["samples_left"]), (18, 7, 0))

        # Rows that a run would not have made show that it did not make them again.
        marked = lines[1].rsplit(",", 1)[0] + ",7\n"
        (self.path / "two/samples.csv").write_text(lines[0] + marked + "".join(lines[2:]))
        self.assertIn("0 new", self.run_well("-o", "two").stdout)
        self.assertEqual(self.text("two/samples.csv"), lines[0] + marked + "".join(lines[2:]))

        # Other pressures and more walls add to a folder; the order is that of one run.
        self.run_well("-o", "grown", "--set", "ensemble.samples=3", "--set", 'ensemble.pressures=["180 mmHg"]')
        self.assertIn("15 new", self.run_well("-o", "grown").stdout)
        assert_same("grown", "grown")

        # Another ensemble's folder is left alone.
        before = {name: self.text(f"grown/{name}") for name in ("samples.csv", "probability.csv", "run.json")}
        for key, value in (("ensemble.seed", "2"), ("ensemble.strength_spread", "0.1"), ("time.end", "0.7 ms")):
            ranks = 2 if key == "ensemble.seed" else None
            result = self.rhexis("run", "e.toml", "-o", "grown", "--set", f"{key}={value}", ranks=ranks)
            self.assert_refused(result, [key, "another ensemble", "-o"], key)
        for name, text in before.items():
            self.assertEqual(self.text(f"grown/{name}"), text)
        os.remove(self.path / "grown/run.json")
        self.assert_refused(self.rhexis("run", "e.toml", "-o", "grown"), ["run.json"], "no record")
        (self.path / "two/samples.csv").write_text(lines[0] + "1,2,3\n")
        self.assert_refused(self.rhexis("run", "e.toml", "-o", "two"), ["samples.csv:2", "1,2,3"], "no sample")

    def check_tables(self, folder):
        """probability.csv counts samples.csv, walls are the same under every pressure, and more pressure ruptures more."""
        samples = self.rows(f"{folder}/samples.csv")
        order = [(int(s["wall"]), float(s["pressure_Pa"])) for s in samples]
        self.assertEqual(order, sorted(order))
        probabilities = self.rows(f"{folder}/probability.csv")
        self.assertEqual([round(float(p["pressure_Pa"]) / 133.322387415) for p in probabilities], [100, 180, 260])
        for p in probabilities:
            mine = [s for s in samples if s["pressure_Pa"] == p["pressure_Pa"]]
            onsets = [float(s["onset_s"]) for s in mine if s["ruptured"] == "1"]
            self.assertEqual((int(p["samples"]), int(p["ruptured"])), (len(mine), len(onsets)))
            self.assertEqual(float(p["probability"]), len(onsets) / len(mine))
            self.assertTrue(float(p["low_95"]) <= float(p["probability"]) <= float(p["high_95"]))
            if onsets:
                self.assertAlmostEqual(float(p["mean_onset_s"]), sum(onsets) / len(onsets), delta=1e-15)
            else:
                self.assertEqual(p["mean_onset_s"], "")
        curve = [float(p["probability"]) for p in probabilities]
        self.assertEqual(curve, sorted(curve))
        self.assertLess(curve[0], curve[-1])
        walls = {}
        for s in samples:
            walls.setdefault(s["wall"], []).append(s)
            self.assertEqual(s["ruptured"] == "1", s["onset_s"] != "")
            if s["ruptured"] == "1":
                self.assertLessEqual(float(s["first_bond_break_s"]), float(s["onset_s"]))
        factors = ("strength_factor", "thickness_factor", "stiffness_factor")
        self.assertEqual(len({tuple(w[0][f] for f in factors) for w in walls.values()}), 6)
        for wall in walls.values():
            self.assertEqual(len({tuple(s[f] for f in factors) for s in wall}), 1)
            ruptured = [s["ruptured"] for s in wall]
            self.assertEqual(ruptured, sorted(ruptured))  # once a wall ruptures, it does so under all higher pressures
            onsets = [float(s["onset_s"]) for s in wall if s["onset_s"]]
            self.assertEqual(onsets, sorted(onsets, reverse=True))

    def test_without_scatter_it_is_the_vessel_alone(self):
        none = [part for key in ("strength", "thickness", "stiffness") for part in ("--set", f"ensemble.{key}_spread=0")]
        self.run_well("-o", "out", *none, "--set", "ensemble.samples=2")
        rows = self.rows("out/samples.csv")
        self.assertEqual([s["ruptured"] for s in rows], ["0", "1", "1"] * 2)  # a step
        for a, b in zip(rows[:3], rows[3:], strict=True):
            self.assertEqual({**a, "wall": ""}, {**b, "wall": ""})
        scene = ENSEMBLE.replace('"ensemble"', '"vessel"')
        start, end = scene.index("[ensemble]"), scene.index("[vessel]")
        self.write(scene[:start] + scene[end:] + "[insitu]\nenabled = false\n[output]\nfields = []\n")
        for s in rows[:3]:
            self.run_well("-o", "alone", "--set", f"load.pressure={s['pressure_Pa']} Pa")
            alone = json.loads(self.text("alone/run.json"))["results"]
            self.assertEqual(float(s["onset_s"]) if s["onset_s"] else None, alone["rupture_onset_s"])
            self.assertEqual(float(s["first_bond_break_s"]) if s["first_bond_break_s"] else None, alone["first_bond_break_s"])
            if s["onset_s"]:
                self.assertEqual(float(s["max_displacement_m"]), alone["max_displacement_at_onset_m"])
        # Another run does not take the samples away.
        before = self.text("out/samples.csv")
        refused = self.rhexis("run", "e.toml", "-o", "out")
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("samples of an ensemble", refused.stderr)
        self.assertEqual(self.text("out/samples.csv"), before)

    def test_interrupt_saves_and_the_same_command_goes_on(self):
        command = [RHEXIS, "run", "e.toml", "-o", "out", "--set", "ensemble.samples=400"]
        process = subprocess.Popen(command, cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        table = self.path / "out/samples.csv"
        while time.monotonic() < deadline and not (table.exists() and table.read_text().count("\n") > 1):
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        out, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, error)
        self.assertIn("Interrupted", out)
        record = json.loads(self.text("out/run.json"))
        self.assertEqual(record["status"], "failed: interrupted by SIGINT")
        done = len(self.rows("out/samples.csv"))
        self.assertEqual((record["results"]["ensemble"]["samples"], record["results"]["ensemble"]["samples_left"]), (done, 1200 - done))
        walls = done // 3 + 2
        result = self.run_well("-o", "out", "--set", f"ensemble.samples={walls}")
        self.assertIn(f"{3 * walls} in all, {3 * walls - done} new", result.stdout)
        self.assertNotIn("count too", result.stdout)
        fewer = self.run_well("-o", "out", "--set", "ensemble.samples=1")
        self.assertIn(f"3, 3 of them done before; {3 * (walls - 1)} others in samples.csv count too", fewer.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
