# SPDX-License-Identifier: BSD-3-Clause
"""Limits: memory that is told before it is taken, odd names, files and settings, tables of pressure from files.

Run by ctest as: test_limits.py RHEXIS MPIRUN...
"""

import os
import re
import subprocess
import sys
import unittest

from vessel_case import GOOD, MPIRUN, RHEXIS, VesselCase, replaced

TABLE = replaced("ramp_time", 'schedule = "table"\ntable_file = "beat.csv"').replace('pressure = "238 kPa"\n', "")
BEAT = "time [us],pressure [kPa]\n0,10\n10,30\n40,10\n"
QUICK = ["--set", "time.end=0.5 us", "--set", "output.every_steps=100"]

# A wall of some 50 MB: name, keys to set.
WALLS = {
    "polar": [],
    "lattice": ["--set", "discretisation.cross_section=lattice"],
    "long": ["--set", "vessel.length=30 mm", "--set", "discretisation.spacing=100 um"],
    "double precision": ["--set", "discretisation.bond_precision=double", "--set", "output.precision=double"],
    "dilatation": ["--set", "material.law=lps", "--set", "vessel.length=1.2 mm"],
    "scatter": ["--set", "scatter.critical_stretch=0.1"],
}
FINE = GOOD.replace('spacing = "100 um"', 'spacing = "50 um"').replace('length = "2 mm"', 'length = "4 mm"').replace('step = "500 ns"', 'step = "100 ns"')

# Arguments of a call that is refused, and what the message must contain.
REFUSED_CALLS = [
    ("no name", ["check", ""], ["name is empty"]),
    ("line break in a name", ["check", "a\nb.toml"], ["control character"]),
    ("a control character in the folder's name", ["run", "vessel.toml", "-o", "a\x1b[31m"], ["control character"]),
    ("two files", ["check", "vessel.toml", "vessel.toml"], ["vessel.toml"]),
    ("a pipe", ["check", "pipe"], ["pipe", "no regular file"]),
    ("a device without end", ["check", "/dev/zero"], ["/dev/zero", "no regular file"]),
    ("a folder", ["check", "."], ["folder"]),
    ("a huge file", ["check", "huge.toml"], ["huge.toml", "too large"]),
    ("--set without value", ["check", "vessel.toml", "--set", "vessel.length"], ["section.name=value"]),
    ("--set of a table", ["check", "vessel.toml", "--set", 'vessel={length="1 mm"}'], ["not a valid value"]),
    ("--set of a long name", ["check", "vessel.toml", "--set", "vessel." + "a" * 100000 + "=1"], ["no such key"]),
    ("--set of a long text", ["check", "vessel.toml", "--set", "load.schedule=" + "a" * 100000], ["load.schedule", "not one of"]),
    ("a pipe as a table", ["check", "table.toml", "--set", "load.table_file=pipe"], ["load.table_file", "no regular file"]),
    ("no such table", ["check", "table.toml", "--set", "load.table_file=nowhere.csv"], ["load.table_file", "nowhere.csv"]),
    ("a table twice", ["check", "table.toml", "--set", 'load.table=[["0 s","0 Pa"],["1 s","1 Pa"]]'], ["load.table_file", "not both"]),
    ("a table that is not used", ["check", "table.toml", "--set", "load.schedule=ramp"], ["load.table_file", "not used"]),
    ("a table without a period", ["check", "table.toml", "--set", "load.repeat=true", "--set", "load.table_file=leap.csv"], ["load.repeat", "30 kPa"]),
    ("a table out of order", ["check", "table.toml", "--set", "load.table_file=back.csv"], ["back.csv:3", "time = 5", "increase"]),
    ("a wall of two metres", ["check", "vessel.toml", "--set", "vessel.outer_radius=2 m", "--set", "discretisation.spacing=250 um"], ["vessel.outer_radius", "particles", "would fit"]),
    ("a spacing too fine", ["check", "vessel.toml", "--set", "discretisation.spacing=1.45 um"], ["discretisation.spacing", "GB", "would fit: discretisation.spacing"]),
    ("the same of a run", ["run", "vessel.toml", "-o", "out", "--set", "discretisation.spacing=1.45 um"], ["discretisation.spacing", "would fit"]),
]


class Limits(VesselCase):
    def setUp(self):
        super().setUp()
        self.write(GOOD)
        self.write(TABLE, "table.toml")
        self.write(BEAT, "beat.csv")
        self.write("time [us],pressure [kPa]\n0,10\n40,30\n", "leap.csv")
        self.write("time [us],pressure [kPa]\n10,10\n5,30\n", "back.csv")
        os.mkfifo(self.path("pipe"))
        with open(self.path("huge.toml"), "wb") as file:
            file.truncate(10**10)
        self.inputs = sorted(os.listdir(self.folder.name))

    def child(self, *arguments):
        """Status, what was said, and the peak of resident memory in bytes, of one rank; it counts what this test itself
        takes, too, which has to stay below that."""
        process = subprocess.Popen([RHEXIS, *arguments], cwd=self.folder.name, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        said = process.stdout.read()
        process.stdout.close()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, said, usage.ru_maxrss * 1024

    # -- what is refused -----------------------------------------------------------------------------------------

    def test_odd_calls_get_one_error_and_nothing_is_written(self):
        for name, arguments, fragments in REFUSED_CALLS:
            with self.subTest(name):
                result = self.rhexis(*arguments)
                self.assertEqual(result.returncode, 2, result.stderr)
                for fragment in fragments:
                    self.assertIn(fragment, result.stderr)
                self.assertLess(len(result.stderr), 1500)
                self.assertEqual(sorted(os.listdir(self.folder.name)), self.inputs)

    def test_more_ranks_than_the_wall_can_be_dealt_out_to(self):
        result = self.rhexis("run", "vessel.toml", "-o", "out", "--set", "discretisation.spacing=0.5 mm", "--set", "vessel.length=4 mm", "--set",
                             "vessel.inner_radius=0.3 mm", "--set", "vessel.outer_radius=0.8 mm", "--set", "boundary.ends=free", ranks=11)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("use fewer ranks", result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder.name)), self.inputs)

    # -- threads -------------------------------------------------------------------------------------------------

    def test_odd_numbers_of_threads(self):
        for value, fragment in (("99999", "more threads than"), ("0", "no number of threads"), ("abc", "no number of threads"),
                                ("-2", "no number of threads"), ("2,3", ""), (" 1", "")):
            with self.subTest(value):
                said = subprocess.run([RHEXIS, "check", "vessel.toml", *QUICK], cwd=self.folder.name, capture_output=True, text=True, timeout=300,
                                      stdin=subprocess.DEVNULL, check=False, env={**os.environ, "OMP_NUM_THREADS": value})
                self.assertEqual(said.returncode, 0, said.stderr)
                if fragment:
                    self.assertIn(f'OMP_NUM_THREADS = "{value}"', said.stderr)
                    self.assertIn(fragment, said.stderr)
                else:
                    self.assertNotIn("OMP_NUM_THREADS =", said.stderr)

    # -- memory --------------------------------------------------------------------------------------------------

    def test_memory_is_told_first_and_is_an_upper_bound(self):
        self.write(FINE, "fine.toml")
        empty = {}
        for command in (["check"], ["run", "-o", "out"]):
            status, said, empty[command[0]] = self.child(*command, "vessel.toml", "--set", "discretisation.spacing=250 um", "--set", "boundary.ends=free", *QUICK)
            self.assertEqual(status, 0, said)
        for name, keys in WALLS.items():
            with self.subTest(name):
                status, said, peak = self.child("check", "fine.toml", *keys, *QUICK)
                self.assertEqual(status, 0, said)
                self.assertTrue(said.lstrip().startswith("memory"), said)
                run, check = (1e6 * float(number.replace(",", "")) for number in re.search(r"about ([\d,]+) MB .* up to ([\d,]+) MB", said).groups())
                self.assert_bound(max(check, 0), peak - empty["check"], "check")
                status, said, peak = self.child("run", "fine.toml", "-o", "out", *keys, *QUICK)
                self.assertEqual(status, 0, said)
                self.assert_bound(run, peak - empty["run"], "run")

    def test_a_long_table_in_the_input_counts(self):
        self.write(FINE, "fine.toml")
        small = ["--set", "discretisation.spacing=250 um", "--set", "boundary.ends=free", *QUICK]
        status, said, empty = self.child("check", "fine.toml", *small)
        self.assertEqual(status, 0, said)
        rows = "\n".join(f'  ["{i} us", "{i % 1000} kPa"],' for i in range(100000))
        table = f'schedule = "table"\ntable = [\n{rows}\n]'
        self.write(FINE.replace('pressure = "238 kPa"\nramp_time = "0.1 ms"', table), "fine.toml")
        status, said, peak = self.child("check", "fine.toml", *small)
        self.assertEqual(status, 0, said)
        self.assert_bound(1e6 * float(re.search(r"up to (\d+) MB", said).group(1)), peak - empty, "check")

    def assert_bound(self, told, taken, what):
        noise = 6e6  # of libraries, and of a wall that is not quite none
        self.assertLessEqual(taken, told + noise, what)
        self.assertLessEqual(told, 1.3 * taken + noise, what)

    # -- tables --------------------------------------------------------------------------------------------------

    def test_table_from_a_file_is_followed_and_repeated(self):
        os.mkdir(self.path("inputs"))
        for name in ("table.toml", "beat.csv"):
            os.rename(self.path(name), self.path("inputs/" + name))
        result = self.rhexis("run", "inputs/table.toml", "-o", "out", "--set", "load.repeat=true", "--set", "time.end=100 us")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("30 kPa (table of 3 points to 40 us, repeated)", result.stdout)
        for row in self.history("out"):
            t = float(row["time_s"]) * 1e6 % 40
            if min(t, 40 - t) > 1e-6:
                self.assertAlmostEqual(float(row["pressure_Pa"]) / 1e3, 10 + 2 * t if t < 10 else 30 - (t - 10) * 2 / 3, 6)
        record = self.record("out")["input"]["load"]["table_file"]
        self.assertEqual(record["value"], "beat.csv")
        self.assertRegex(record["checksum"], "^fnv1a:[0-9a-f]{16}$")

    def test_a_restart_notices_another_table(self):
        self.write(TABLE + "checkpoint_every = 40\n", "table.toml")
        self.assertEqual(self.rhexis("run", "table.toml", "-o", "out").returncode, 0)
        again = ["run", "table.toml", "-o", "again", "--restart", "out/checkpoints/step_000040.h5"]
        result = self.rhexis(*again)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("table_file", result.stderr)
        self.write(BEAT.replace("40,10", "40,11"), "beat.csv")
        result = self.rhexis(*again)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("load.table_file", result.stderr)
        self.assertIn("other contents", result.stderr)

    def test_long_table(self):
        with open(self.path("long.csv"), "w", encoding="utf-8") as file:
            file.write("time [us],pressure [kPa]\n")
            file.writelines(f"{i * 1e-4:.4f},{10 + i % 7}\n" for i in range(1000000))
        result = self.rhexis("run", "table.toml", "-o", "out", "--set", "load.table_file=long.csv", "--set", "time.end=5 us")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1000000 points", result.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
