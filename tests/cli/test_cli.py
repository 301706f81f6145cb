# SPDX-License-Identifier: BSD-3-Clause
"""The program as its users meet it: the command line, wrong inputs, the record of a run.

Run by ctest as: test_cli.py RHEXIS MPIRUN...
"""

import calendar
import os
import subprocess
import sys
import time
import unittest

from vessel_case import GOOD, MPIRUN, RHEXIS, VesselCase, replaced

# name, input text, what the message must contain besides the file's name
WRONG_INPUTS = [
    ("unit missing", replaced("length", 'length = "2"'), [":4:", "vessel.length", "unit"]),
    ("number for a quantity", replaced("length", "length = 2.0"), [":4:", "vessel.length", "unit"]),
    ("wrong dimension", replaced("length", 'length = "2 kPa"'), [":4:", "vessel.length", "length"]),
    ("unknown unit", replaced("length", 'length = "2 furlongz"'), [":4:", "furlongz"]),
    ("no number", replaced("length", 'length = "long"'), [":4:", "vessel.length"]),
    ("nan", replaced("length", 'length = "nan mm"'), [":4:", "vessel.length"]),
    ("infinite", replaced("length", 'length = "inf mm"'), [":4:", "vessel.length"]),
    ("zero", replaced("length", 'length = "0 mm"'), [":4:", "greater than 0"]),
    ("negative", replaced("inner_radius", 'inner_radius = "-1.5 mm"'), [":2:", "greater than 0"]),
    ("unknown key", replaced("length", 'lenght = "2 mm"'), [":4:", "lenght", "length"]),
    ("unknown section", GOOD.replace("[load]", "[laod]"), ["laod", "load"]),
    ("key in the wrong section", replaced("ramp_time", 'young_modulus = "3 MPa"'), ["young_modulus", "material"]),
    ("missing key", replaced("length", ""), ["vessel.length", "missing"]),
    ("empty file", "", ["vessel.inner_radius"]),
    ("duplicate key", replaced("length", 'length = "2 mm"\nlength = "3 mm"'), [":5:"]),
    ("not TOML", replaced("length", "length = = 2"), [":4:"]),
    ("open string", replaced("length", 'length = "2 mm'), [":4:"]),
    ("open section", GOOD.replace("[vessel]", "[vessel"), [":1:"]),
    ("nested table", GOOD + "[load.more]\nx = 1\n", ["load.more"]),
    ("date", replaced("length", "length = 2020-01-01"), [":4:"]),
    ("boolean for a quantity", replaced("length", "length = true"), [":4:", "vessel.length"]),
    ("list for a quantity", replaced("length", 'length = ["2 mm"]'), [":4:", "vessel.length"]),
    ("binary", "\x00\x01\x02\n", []),
    ("radii swapped", replaced("outer_radius", 'outer_radius = "1 mm"'), [":3:", "outer_radius", "inner_radius"]),
    ("radii equal", replaced("outer_radius", 'outer_radius = "1.5 mm"'), [":3:", "above"]),
    ("horizon too small", replaced("spacing", 'spacing = "100 um"\nhorizon = "150 um"'), ["horizon", "2"]),
    ("horizon too large", replaced("spacing", 'spacing = "100 um"\nhorizon = "1 mm"'), ["horizon", "8"]),
    ("spacing and particles", replaced("spacing", 'spacing = "100 um"\nparticles = 1000'), ["particles", "both"]),
    ("neither spacing nor particles", replaced("spacing", ""), ["spacing"]),
    ("spacing wider than the wall", replaced("spacing", 'spacing = "0.6 mm"'), ["spacing", "wall"]),
    ("too many particles", replaced("spacing", 'spacing = "10 nm"'), ["spacing", "particles"]),
    ("half a particle", replaced("spacing", "particles = 1000.5"), ["particles"]),
    ("choice", replaced("spacing", 'spacing = "100 um"\ncross_section = "polr"'), ["polr", "polar", "lattice"]),
    ("lattice shift of one number", replaced("spacing", 'spacing = "100 um"\nlattice_shift = [0.5]'), ["lattice_shift", "two"]),
    ("lattice shift beyond one", replaced("spacing", 'spacing = "100 um"\nlattice_shift = [0.5, 3]'), ["lattice_shift"]),
    ("negative pressure", replaced("pressure", 'pressure = "-1 kPa"'), ["load.pressure"]),
    ("table without points", replaced("ramp_time", 'schedule = "table"'), ["load.table", "two"]),
    ("table out of order", replaced("ramp_time", 'schedule = "table"\ntable = [["1 ms", "0 kPa"], ["0 ms", "1 kPa"]]'), ["load.table", "increase"]),
    ("table point without unit", replaced("ramp_time", 'schedule = "table"\ntable = [["1", "0 kPa"], ["2 ms", "1 kPa"]]'), ["load.table", "unit"]),
    ("table that is not used", replaced("ramp_time", 'table = [["0 ms", "0 kPa"], ["2 ms", "1 kPa"]]'), ["load.table"]),
    ("layer thinner than a spacing", replaced("ramp_time", 'layer_thickness = "1 um"'), ["load.layer_thickness"]),
    ("time step above the stable one", replaced("step", 'step = "5 us"'), [":15:", "time.step", "stable", "auto"]),
    ("time step of zero", replaced("step", 'step = "0 us"'), ["time.step"]),
    ("step fraction above one", replaced("step", "step_fraction = 1.5"), ["time.step_fraction"]),
    ("no end", replaced("end", 'end = "0 s"'), ["time.end"]),
    ("both output intervals", replaced("every_steps", 'every_steps = 20\nevery_time = "1 us"'), ["output.every_time"]),
    ("output every zero steps", replaced("every_steps", "every_steps = 0"), ["output.every_steps"]),
    ("unknown field", replaced("every_steps", 'fields = ["damge"]'), ["damge", "damage"]),
    ("ends that hold all", GOOD + '[boundary]\nend_length = "1 mm"\n', ["end_length"]),
    ("ends that hold all, rounded to rows", GOOD.replace('length = "2 mm"', 'length = "0.7 mm"') + '[boundary]\nend_length = "0.34 mm"\n',
     ["boundary.end_length", "4 rows"]),
    ("periodic piece too short", GOOD.replace('length = "2 mm"', 'length = "0.5 mm"') + '[boundary]\nends = "axial_periodic"\n', ["vessel.length", "horizon"]),
    ("script that is no script", GOOD + '[insitu]\nscripts = ["/etc/hostname"]\n', ["insitu.scripts", "/etc/hostname", ".py"]),
    ("spot without a place", GOOD + '[[spot]]\nradius = "1 mm"\n', ["spot[1].position", "missing"]),
    ("spot beyond the end", GOOD + '[[spot]]\nposition = "3 mm"\nradius = "1 mm"\n', [":21:", "spot[1].position", "2 mm"]),
    ("unknown key of a spot", GOOD + '[[spot]]\npositoin = "1 mm"\n', [":21:", "spot[1].positoin", "position"]),
    ("one spot as a section", GOOD + '[spot]\nposition = "1 mm"\n', [":20:", "[[spot]]"]),
    ("spot of no thickness", GOOD + '[[spot]]\nposition = "1 mm"\nradius = "1 mm"\nthickness = 0.1\n', [":23:", "thickness", "spacing"]),
    ("scatter of another law", GOOD + '[scatter]\nlaw = "gauss"\n', [":21:", "scatter.law", "weibull"]),
    ("critical stretch of zero", GOOD + "[material]\ncritical_stretch = 0\n", ["critical_stretch"]),
    ("energy release rate and critical stretch", GOOD + '[material]\ncritical_stretch = 0.2\nenergy_release_rate = "90 J/m2"\n',
     ["energy_release_rate", "both"]),
    ("energy release rate without unit", GOOD + '[material]\nenergy_release_rate = "90"\n', ["energy_release_rate", "unit"]),
    ("energy release rate beyond all stretches", GOOD + '[material]\nenergy_release_rate = "1 MJ/m2"\n', ["energy_release_rate", "stretch of"]),
    ("missing script", GOOD + '[insitu]\nscripts = ["nowhere.py"]\n', ["insitu.scripts", "nowhere.py"]),
]


class Cli(VesselCase):
    # -- what it prints ------------------------------------------------------------------------------------------

    def test_version_help_and_keys(self):
        self.assertIn("Rhexis", self.rhexis("--version").stdout)
        self.assertIn("run", self.rhexis("--help").stdout)
        keys = self.rhexis("keys").stdout
        for key in ("vessel.inner_radius", "load.venting", "insitu.scripts", "output.every_steps"):
            self.assertIn(key.split(".")[1], keys)
        self.assertNotIn("venting", self.rhexis("keys", "time").stdout)
        wrong = self.rhexis("keys", "laod")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("load", wrong.stderr)

    def test_wrong_calls(self):
        for arguments in ([], ["fly"], ["run"], ["run", "a.toml", "--fast"], ["run", "a.toml", "-o", ""]):
            self.assertEqual(self.rhexis(*arguments).returncode, 2, arguments)

    def test_check_tells_derived_numbers_and_writes_nothing(self):
        self.write(GOOD)
        result = self.rhexis("check", "vessel.toml")
        self.assertEqual(result.returncode, 0, result.stderr)
        for text in ("11,000", "100 um", "350 um", "0.73 % off Lame", "stable"):
            self.assertIn(text, result.stdout)
        self.assertEqual(os.listdir(self.folder.name), ["vessel.toml"])

    def test_strength_by_energy_release_rate(self):
        # s0 = sqrt(5 G0 / (6 E delta)).
        self.write(GOOD)
        for horizon, s0 in (("350 um", "0.2474"), ("280 um", "0.2766")):
            sets = ["--set", "material.energy_release_rate=90 J/m2", "--set", f"discretisation.horizon={horizon}"]
            for command in ("check", "run"):
                said = self.rhexis(command, "vessel.toml", *sets).stdout
                self.assertIn(f"critical stretch {s0}", said)
                self.assertIn("90 J/m2", said)
        self.assertIn("energy release rate 91.87 J/m2", self.rhexis("check", "vessel.toml").stdout)

    # -- wrong input ---------------------------------------------------------------------------------------------

    def assert_refused(self, result, fragments, name):
        self.assertEqual(result.returncode, 2, f"{name}: {result.stderr}")
        message = result.stderr
        self.assertEqual(message.count("rhexis: "), 1, f"{name}: not one message: {message}")
        for fragment in fragments:
            self.assertIn(fragment, message, name)
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["vessel.toml"], f"{name}: something was written")

    def test_wrong_inputs(self):
        self.assertGreaterEqual(len(WRONG_INPUTS), 40)
        for name, text, fragments in WRONG_INPUTS:
            with self.subTest(name):
                self.write(text)
                self.assert_refused(self.rhexis("run", "vessel.toml"), ["vessel.toml", *fragments], name)

    def test_wrong_input_is_said_once_by_several_ranks(self):
        for name, text, fragments in WRONG_INPUTS[:3] + WRONG_INPUTS[-12:-10]:
            self.write(text)
            self.assert_refused(self.rhexis("run", "vessel.toml", ranks=3), fragments, name)

    def test_a_rank_without_units_ends_the_run_for_all(self):
        self.write(GOOD)
        # Rank 1 lacks them. (`mpirun -n 1 A : -n 1 B` would say so more plainly, but Debian 13's mpirun fails with any A and B.)
        script = '[ "$OMPI_COMM_WORLD_RANK" = 1 ] && export UDUNITS2_XML_PATH=/none; exec "$@"'
        result = subprocess.run([*MPIRUN, "-n", "2", "sh", "-c", script, "sh", RHEXIS, "check", "vessel.toml"],
                                cwd=self.folder.name, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertEqual(result.stderr.count("UDUNITS"), 2, result.stderr)  # in one message

    def test_wrong_overrides(self):
        self.write(GOOD)
        for override, fragment in (("time.step", "="), ("time.stepp=1 us", "time.step"), ("time.step=fast", "time.step"),
                                   ("time.step=3 us", "stable"), ("vessel.length=2", "unit")):
            self.assert_refused(self.rhexis("run", "vessel.toml", "--set", override), ["--set", fragment], override)

    def test_unreadable_files(self):
        self.write(GOOD)
        for file in ("absent.toml", "."):
            result = self.rhexis("run", file)
            self.assert_refused(result, [file], file)

    def test_folder_that_cannot_be_written(self):
        self.write(GOOD)
        for folder in ("vessel.toml", "vessel.toml/below", "/proc/nowhere"):
            for ranks in (None, 2):
                self.assert_refused(self.rhexis("run", "vessel.toml", "-o", folder, ranks=ranks), ["cannot write"], folder)

    # -- running -------------------------------------------------------------------------------------------------

    def test_run_leaves_a_record(self):
        self.write(GOOD)
        result = self.rhexis("run", "vessel.toml")
        self.assertEqual(result.returncode, 0, result.stderr)
        record = self.record("results/vessel")
        self.assertEqual(record["status"], "completed")
        self.assertEqual(record["results"]["particles"], 11000)
        self.assertEqual(record["results"]["steps"], 100)
        self.assertEqual(record["performance"]["ranks"], 1)
        self.assertGreater(record["performance"]["bond_evaluations"], 1e6)
        self.assertLess(abs(record["results"]["energy_drift"]), 1e-3)
        self.assertIsNone(record["results"]["network"]["vessels"])
        rows = self.history("results/vessel")
        self.assertEqual([row["step"] for row in rows], ["0", "20", "40", "60", "80", "100"])
        self.assertAlmostEqual(float(rows[-1]["pressure_Pa"]), 119e3, delta=1)

    def test_history_is_the_same_for_any_ranks(self):
        self.write(GOOD)
        for ranks in (1, 2, 3):
            result = self.rhexis("run", "vessel.toml", "-o", f"r{ranks}", "--quiet", ranks=ranks)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stdout, "")
        self.assertEqual(self.history("r1"), self.history("r2"))
        self.assertEqual(self.history("r1"), self.history("r3"))

    def test_slow_ramps_are_not_taken_for_unstable(self):
        self.write(GOOD)
        for ramp in ("2 s", "1e6 s"):
            result = self.rhexis("run", "vessel.toml", "--set", f"load.ramp_time={ramp}", "--set", "load.schedule=smooth_ramp")
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_folder_is_for_one_run_at_a_time(self):
        self.write(GOOD)
        endless = ("--set", "time.end=10 s", "--set", "output.every_steps=1000000")
        first = subprocess.Popen([RHEXIS, "run", "vessel.toml", "-o", "out", *endless], cwd=self.folder.name,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            while not os.path.exists(self.path("out/history.csv")):
                self.assertIsNone(first.poll())
                time.sleep(0.01)
            result = self.rhexis("run", "vessel.toml", "-o", "out")
            self.assertEqual(result.returncode, 2)
            self.assertIn("another run is still writing there", result.stderr)
            self.assertTrue(os.path.exists(self.path("out/history.csv")))
        finally:
            first.kill()
            first.wait()
        self.assertEqual(self.rhexis("run", "vessel.toml", "-o", "out").returncode, 0)

    def test_output_by_time(self):
        self.write(replaced("every_steps", 'every_time = "12.5 us"'))
        self.rhexis("run", "vessel.toml", "-o", "out")
        for row, time_s in zip(self.history("out"), [0, 12.5e-6, 25e-6, 37.5e-6, 50e-6], strict=True):
            self.assertAlmostEqual(float(row["time_s"]), time_s, delta=1e-12)

    def test_failing_script_is_status_3_and_the_data_is_safe(self):
        if "Catalyst" not in self.rhexis("--version").stdout:
            self.skipTest("built without ParaView")
        with open(self.path("bad.py"), "w", encoding="utf-8") as file:
            file.write("def catalyst_execute(info):\n    if info.timestep > 20:\n        raise ValueError('too late')\n")
        self.write(GOOD + '[insitu]\nscripts = ["bad.py"]\n')
        result = self.rhexis("run", "vessel.toml", "-o", "out", ranks=2)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertEqual(result.stderr.count("too late"), 1, result.stderr)
        self.assertIn("bad.py", result.stderr)
        self.assertTrue(self.record("out")["status"].startswith("failed: "))
        self.assertEqual([row["step"] for row in self.history("out")], ["0", "20", "40"])

    def test_the_record_tells_how_to_run_it_again(self):
        self.write(GOOD)
        more = ["--set", "boundary.ends=axial_periodic", "--set", "boundary.end_length=0.5 mm", "--set", "time.end=20 us"]
        before = time.time()
        result = self.rhexis("run", "vessel.toml", "-o", "out", *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        record = self.record("out")
        self.assertEqual(record["command"], [RHEXIS, "run", "vessel.toml", "-o", "out", *more])
        self.assertEqual(record["file"], "vessel.toml")
        started = calendar.timegm(time.strptime(record["started"], "%Y-%m-%dT%H:%M:%SZ"))
        self.assertLessEqual(abs(started - before), 10)
        [warning] = record["warnings"]
        self.assertIn('boundary.end_length=0.5 mm: has no effect where boundary.ends = "axial_periodic"', warning)
        self.assertIn(f"rhexis: warning: {warning}\n", result.stderr)

    def test_what_breaks_at_the_last_moment_is_told(self):
        self.write(replaced("end", 'end = "200 us"') + "[material]\ncritical_stretch = 0.1\n")
        def results(*more):
            result = self.rhexis("run", "vessel.toml", "-o", "out", *more)
            self.assertEqual(result.returncode, 0, result.stderr)
            return self.record("out")["results"]
        whole = results()
        onset = whole["rupture_onset_s"]
        self.assertAlmostEqual(whole["pressure_at_onset_Pa"], 238e3 * min(onset / 0.1e-3, 1), delta=1)
        moments = {key: whole[key] for key in ("first_bond_break_s", "rupture_onset_s")}
        for key, moment in moments.items():
            ended = results("--set", f"time.end={moment} s")
            self.assertEqual(ended["simulated_s"], moment)
            self.assertEqual(ended[key], moment)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
