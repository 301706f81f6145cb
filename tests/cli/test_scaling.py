# SPDX-License-Identifier: BSD-3-Clause
"""The scaling study: fits, the performance model, a small study from run to table, job scripts, wrong arguments.

Run by ctest as: test_scaling.py RHEXIS SOURCE_DIR MPIRUN...
"""

import contextlib
import csv
import io
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import numpy
from matplotlib import image

RHEXIS, SOURCE, MPIRUN = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
SCRIPT = SOURCE / "postprocessing/scaling_study.py"
sys.path.insert(0, str(SCRIPT.parent))

import scaling_study
from performance_model import Machine, Network, Wall, core_rate, fit_power_law, nodes_of, solve_seconds

# 550 columns x 16 rows, 20 steps.
VESSEL = """\
[vessel]
inner_radius = "1.5 mm"
outer_radius = "2 mm"
length = "1.6 mm"

[discretisation]
spacing = "100 um"

[load]
pressure = "238 kPa"
ramp_time = "0.1 ms"

[time]
step = "500 ns"
end = "10 us"

[output]
every_steps = 10
fields = []

[insitu]
enabled = false
"""

TREE = """\
[scene]
model = "network"

[tree]
generations = 10

[flow]
inlet_pressure = "95 mmHg"
outlet_pressure = "3 mmHg"

[network]
shown_vessels = 2

[insitu]
enabled = false
"""


class Fit(unittest.TestCase):
    def test_known_laws_are_recovered(self):
        nodes, vessels = 2.0 ** numpy.arange(11), 2.0 ** numpy.arange(25, 36)
        for p, alpha, beta, gamma in ((nodes, 0.106, 1.54e-3, 1.0), (nodes, 0.71, 0.18, 0.98), (nodes[:4], 5, 2, 2.5),
                                      (vessels, 0, 1.47e-9, 1.05), (vessels, 1.27e12, 1.21e6, 0.58)):
            law = fit_power_law(p, alpha + beta * p**gamma)
            self.assertAlmostEqual(law.gamma, gamma, delta=1e-6)
            self.assertAlmostEqual(law.alpha, alpha, delta=1e-5 * (alpha + beta * p[0] ** gamma))
            self.assertAlmostEqual(law.beta / beta, 1, delta=1e-4)
            self.assertFalse(law.at_bound)

    def test_noise_moves_the_exponent_little(self):
        p = 2.0 ** numpy.arange(11)
        noise = 1 + 0.03 * numpy.random.default_rng(1).standard_normal(len(p))
        law = fit_power_law(p, (0.5 + 0.2 * p) * noise)
        self.assertAlmostEqual(law.gamma, 1, delta=0.05)
        self.assertAlmostEqual(law.deviation, 0.03, delta=0.015)

    def test_what_does_not_grow_has_no_exponent(self):
        for resource in ([7, 7, 7, 7], [7, 7.01, 6.99, 7], [8, 4, 2, 1]):
            law = fit_power_law([1, 2, 4, 8], resource)
            self.assertEqual((law.beta, law.gamma), (0, None))

    def test_three_sizes_do_not_determine_three_unknowns(self):
        self.assertIsNone(fit_power_law([1, 2, 4, 4], [1, 2, 4, 4]))


class Model(unittest.TestCase):
    WALL = Wall(columns=548, rows=160, family=130, reach=3, cut_columns=17.4, bytes=12)
    MACHINE = Machine(latency_s=1e-6, bandwidth_B_s=1e10, cores_per_node=4)

    def test_a_rank_has_its_share_and_halo(self):
        self.assertEqual(self.WALL.busiest(1).particles, 548 * 160)
        self.assertEqual(self.WALL.busiest(1).messages, 0)
        two = self.WALL.busiest(2)  # half of the columns each; those beside the cut, on both sides, come from the other
        self.assertEqual((two.particles, two.messages, two.bytes), (274 * 160, 1, 2 * 17.4 * 160 * 12))
        rows = Wall(columns=548, rows=1600, family=130, reach=3, cut_columns=80, bytes=12).busiest(2)  # 50 blocks each
        self.assertEqual((rows.particles, rows.messages, rows.bytes), (548 * 800, 1, 548 * 3 * 12))
        self.assertIsNone(self.WALL.busiest(548 * 10 + 1))
        self.assertEqual([nodes_of(*shape, 48) for shape in ((48, 1), (6, 32), (49, 1), (1, 96))], [1, 6, 2, 1])

    def test_measured_rate_gives_the_measured_time_back(self):
        for problem in (self.WALL, Network(1e6)):
            rate = core_rate(problem, {"ranks": 1, "threads": 2, "steps": 100, "solve_s": 3.0})
            self.assertAlmostEqual(solve_seconds(problem, 1, 2, 100, rate, self.MACHINE), 3.0)
            two = problem.busiest(2)
            expected = 3.0 * (1 + two.cuts / two.particles)
            self.assertAlmostEqual(solve_seconds(problem, 2, 1, 100, rate, self.MACHINE), expected, delta=0.1)

    def test_a_slow_network_takes_its_time(self):
        slow = Machine(latency_s=1.0, bandwidth_B_s=1e10, cores_per_node=4)
        self.assertAlmostEqual(solve_seconds(self.WALL, 2, 1, 1, 1e12, slow), 1 + 2, delta=1e-3)  # a message, and a reduction


class Study(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rhexis_scaling_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.output = self.folder / "study"
        self.vessel, self.tree = self.folder / "vessel.toml", self.folder / "tree.toml"
        self.vessel.write_text(VESSEL)
        self.tree.write_text(TREE)

    def study(self, *arguments, status=0):
        """The script in a process of its own, as a user starts it."""
        result = subprocess.run([sys.executable, SCRIPT, *map(str, arguments)], capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, status, result.stderr)
        return result

    def here(self, *arguments):
        return self.study(*arguments, "--program", RHEXIS, "--launcher", shlex.join(MPIRUN), "--repeat", 1, "-o", self.output)

    def table(self):
        with open(self.output / "scaling.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_strong_and_weak_scaling_of_a_vessel(self):
        said = self.here(self.vessel, "--strong", "--weak", "vessel.length=1.6 mm", "--layouts", "1x1", "2x1",
                         "--predict", 4).stdout
        rows = self.table()
        self.assertEqual([(row["study"], row["size"], row["ranks"], row["particles"], row["runs"]) for row in rows],
                         [("strong", "", "1", "8800", "1"), ("strong", "", "2", "8800", "1"),
                          ("weak", "vessel.length=1.6 mm", "1", "8800", "1"), ("weak", "vessel.length=3.2 mm", "2", "17600", "1"),
                          ("strong", "", "4", "", "0"), ("weak", "", "4", "", "0")])
        for row in rows[:4]:
            first = rows[0 if row["study"] == "strong" else 2]
            ratio = float(first["wall_s"]) / float(row["wall_s"])
            if row["study"] == "strong":
                self.assertAlmostEqual(float(row["speedup"]), ratio)  # Eq. (11)
                self.assertEqual(row["flop"], first["flop"])
            else:
                self.assertAlmostEqual(float(row["efficiency"]), ratio)  # Eq. (12)
            self.assertEqual(row["predicted_wall_s"] == "", row["ranks"] == "1")
        self.assertIn("none: fewer than 4 sizes", said)
        self.assertIn("Predictions, not measured", said)
        network = json.loads((self.output / "scaling.json").read_text())["network"]
        measured = [json.loads(path.read_text())["performance"]["message_latency_s"]
                    for path in self.output.glob("runs/*2x1*/**/run.json")]
        within, between = network
        self.assertEqual(between["source"], "as usual, not measured")
        if os.cpu_count() > 1:
            self.assertEqual(within["source"], "as measured")
            self.assertTrue(min(measured) <= within["latency_s"] <= max(measured), (network, measured))
        record = json.loads((self.output / "scaling.json").read_text())
        self.assertEqual(record["machine"]["cores"], str(os.cpu_count()))
        self.assertRegex(record["machine"]["program"], r"^[\d.]+ \(")
        for name in ("strong", "weak"):
            self.assertEqual(image.imread(self.output / f"{name}.png").shape[:2], (540, 2220))

    def test_sizes_of_a_network_are_fitted_beside_the_paper(self):
        said = self.here(self.tree, "--sizes", "tree.generations=8,10,12,14", "--layouts", "1x1").stdout
        self.assertEqual([int(row["p"]) for row in self.table()], [2 * (2**k - 1) for k in (8, 10, 12, 14)])
        self.assertRegex(said, r"\| sizes on 1x1 \| time \(core-h\) \| vessels \| [^n|]+ \| [\d.]+% \| 1\.47e-9 p\^1\.05 \|")
        self.assertTrue((self.output / "sizes.png").exists())

    def test_jobs_for_slurm_are_written_and_collected(self):
        jobs = self.folder / "jobs"
        self.study(self.vessel, "--program", RHEXIS, "--layouts", "2x2", "8x2", "--cores-per-node", 4, "--repeat", 2,
                   "--slurm", jobs, "--slurm-option=--time=00:10:00")
        scripts = sorted(jobs.glob("*.sbatch"))
        self.assertEqual([path.name for path in scripts], ["01_strong_2x2.sbatch", "02_strong_8x2.sbatch"])
        text = scripts[1].read_text()
        for line in ("#SBATCH --nodes=4", "#SBATCH --ntasks=8", "#SBATCH --cpus-per-task=2", "#SBATCH --time=00:10:00",
                     "export OMP_NUM_THREADS=2"):
            self.assertIn(line + "\n", text)
        self.assertEqual(text.count("\nsrun "), 2)
        for path in scripts:
            subprocess.run(["bash", "-n", path], check=True)

        self.assertIn("no finished run", self.study("--collect", jobs, status=1).stderr)
        # The first job, with mpirun in the place of srun.
        srun = self.folder / "srun"
        srun.write_text(f'#!/bin/bash\nexec {shlex.join(MPIRUN)} -n 2 "${{@:3}}"\n')
        srun.chmod(0o755)
        subprocess.run(["bash", scripts[0]], check=True, env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
        collected = self.study("--collect", jobs)
        self.output = jobs
        self.assertEqual([(row["ranks"], row["threads"], row["runs"]) for row in self.table() if row["runs"] != "0"],
                         [("2", "2", "2")])
        self.assertIn(f"warning: no finished run in {jobs / 'runs/02_strong_8x2'}", collected.stderr)

    def test_wrong_arguments(self):
        for arguments, said in (
            ([], "input file or --collect"),
            ([self.vessel, "--collect", self.folder], "input file or --collect"),
            (["--collect", self.folder], "study.json"),
            ([self.folder / "none.toml"], "none.toml"),
            ([self.vessel, "--program", self.folder / "none"], "no program"),
            ([self.vessel, "--launcher", "no_such_mpirun"], "no_such_mpirun"),
            ([self.vessel, "--layouts", "2"], "RANKSxTHREADS"),
            ([self.vessel, "--layouts", "0x1"], "RANKSxTHREADS"),
            ([self.vessel, "--repeat", "0"], "positive whole number"),
            ([self.vessel, "--latency", "-1"], "positive number"),
            ([self.vessel, "--bandwidth", "inf"], "positive number"),
            ([self.vessel, "--weak", "vessel.length"], "KEY=VALUE"),
            ([self.vessel, "--sizes", "vessel.length=1 mm,,2 mm"], "KEY=VALUE"),
            ([self.vessel, "--weak", "vessel.length=1 mm,2 mm", "--layouts", "1x1"], "2 values for 1 layouts"),
            ([self.vessel, "--weak", "load.schedule=ramp"], "a value for each layout"),
            ([self.vessel, "--sizes", "vessel.lenght=1 mm"], "vessel.length"),
            ([self.vessel, "--set", "vessel.length=1 kPa"], "vessel.length"),
        ):
            with self.subTest(said=said, arguments=arguments):
                program = [] if "--program" in arguments else ["--program", RHEXIS]
                words = map(str, (SCRIPT, *arguments, *program, "-o", self.output))
                with (unittest.mock.patch("sys.argv", list(words)), contextlib.redirect_stderr(io.StringIO()) as stderr,
                      self.assertRaises(SystemExit) as end):
                    scaling_study.main()
                error = stderr.getvalue()
                self.assertEqual(end.exception.code, 2)
                self.assertRegex(error, r"\Aerror: [^\n]+\n\Z")
                self.assertIn(said, error)
                self.assertFalse(self.output.exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
