# SPDX-License-Identifier: BSD-3-Clause
"""`import rhexis`: check, run, progress, errors, signals, ranks, and the same results as the program's.

Run by ctest as: test_python.py RHEXIS PYTHON_FOLDER SOURCE_DIR MPIRUN...
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest

RHEXIS, FOLDER, SOURCE, MPIRUN = sys.argv[1], os.path.abspath(sys.argv[2]), pathlib.Path(sys.argv[3]), sys.argv[4:]
sys.path.insert(0, FOLDER)

import numpy

import rhexis

VESSEL = SOURCE / "inputs/perivessel.toml"
SHORT = {"vessel.length": "1.2 mm", "time.end": "4 us", "output.every_steps": 2, "load.ramp_time": "2 us"}
LONG = SHORT | {"time.end": "50 ms", "output.every_steps": 1000}


def words(overrides):
    return [word for key, value in overrides.items() for word in ("--set", f"{key}={value if isinstance(value, str) else json.dumps(value)}")]


def script(text, *arguments, launcher=(), **options):
    """A Python of its own that knows rhexis, VESSEL, SHORT, LONG and sys.argv[1:]."""
    names = f"import sys, rhexis\nVESSEL, SHORT, LONG = {str(VESSEL)!r}, {SHORT!r}, {LONG!r}\n"
    return subprocess.Popen([*launcher, sys.executable, "-c", names + textwrap.dedent(text), *arguments], env=os.environ | {"PYTHONPATH": FOLDER},
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


class Python(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def output_of(self, *arguments, status=0, **options):
        process = script(*arguments, **options)
        out, error = process.communicate(timeout=120)
        self.assertEqual(process.returncode, status, error)
        return out

    def test_check(self):
        checked = rhexis.check(VESSEL, SHORT)
        self.assertEqual(checked["model"], "vessel")
        self.assertAlmostEqual(checked["steps"] * checked["time_step_s"], 4e-6, delta=1e-12)
        self.assertEqual(checked["input"]["vessel"]["length"]["value"], 1.2e-3)
        self.assertEqual(checked["particles"], rhexis.run(VESSEL, SHORT)["particles"])

    def test_numpy_numbers_are_overrides(self):
        checked = rhexis.check(VESSEL, SHORT | {"output.every_steps": numpy.int64(3), "material.critical_stretch": numpy.float32(0.25)})
        self.assertEqual(checked["input"]["output"]["every_steps"]["value"], 3)
        self.assertEqual(checked["input"]["material"]["critical_stretch"]["value"], 0.25)

    def test_errors_are_the_programs(self):
        for overrides in ({"vessel.length": "-1 mm"}, {"vessel.lenght": "1 mm"}, {"output.fields": ["damge"]}):
            told = subprocess.run([RHEXIS, "check", VESSEL, *words(overrides)], capture_output=True, text=True, timeout=120).stderr
            for call in (rhexis.check, rhexis.run):
                with self.assertRaises(rhexis.InputError) as raised:
                    call(VESSEL, overrides)
                self.assertEqual(f"rhexis: {raised.exception}\n", told)
        with self.assertRaisesRegex(ValueError, "no_such.toml"):
            rhexis.run("no_such.toml")
        step = f"{2.5 * rhexis.check(VESSEL, SHORT)['stable_time_step_s']} s"
        with self.assertRaisesRegex(rhexis.RunError, "unstable"):
            rhexis.run(VESSEL, SHORT | {"time.step": step, "time.allow_unstable": True, "time.end": "400 us", "output.every_steps": 100})

    def test_a_run_gives_what_the_program_gives(self):
        subprocess.run([RHEXIS, "run", VESSEL, "-o", self.folder / "program", "--quiet", *words(SHORT | {"insitu.enabled": False})], check=True, timeout=120)
        results = rhexis.run(VESSEL, SHORT, output=self.folder / "python")
        records = [json.loads((self.folder / name / "run.json").read_text()) for name in ("program", "python")]
        self.assertEqual(results, records[0]["results"])
        self.assertEqual(results, records[1]["results"])
        self.assertEqual((self.folder / "program/history.csv").read_text(), (self.folder / "python/history.csv").read_text())
        self.assertEqual(list(self.folder.rglob("*.png")), [])

    def test_an_ensemble(self):
        ensemble = rhexis.run(SOURCE / "inputs/rupture_probability.toml", {"ensemble.samples": 1, "ensemble.pressure_count": 2, "time.end": "3 us"})
        self.assertEqual(ensemble["ensemble"]["samples"], 2)

    def test_progress_sees_a_network(self):
        seen = []

        def progress(particles, network):
            self.assertIsNone(particles)
            ends, pressure, flow = network.connectivity, network["pressure"], network["flow"]
            self.assertFalse(ends.flags.writeable or pressure.flags.owndata)
            self.assertEqual((ends.shape, flow.shape, network.fields["flow"]), ((30, 2), (30,), "m3/s"))
            seen.append(float(((pressure[ends[:, 0]] - pressure[ends[:, 1]]) * flow).min()))

        results = rhexis.run(SOURCE / "inputs/cvdt_30.toml", output=self.folder, progress=progress)
        self.assertEqual(results["network"]["vessels"], 30)
        self.assertEqual(len(seen), 1)
        self.assertGreater(seen[0], 0, "blood flows down the pressure in every vessel")

    def test_progress_sees_both(self):
        both = []
        rhexis.run(SOURCE / "inputs/two_way.toml", {"time.end": "20 us", "output.every_steps": 100000},
                   progress=lambda particles, network: both.append((particles["damage"].size, network["pressure"].size)))
        self.assertEqual(len(both), 2)
        self.assertTrue(min(both[0]) > 0)

    def test_progress_sees_the_solver(self):
        seen = []

        def progress(particles, network):
            self.assertIsNone(network)
            u = particles["displacement"]
            self.assertFalse(u[0].flags.owndata or u[0].flags.writeable)
            self.assertEqual(particles["damage"].shape, u[2].shape)
            self.assertEqual(particles.fields, {"position": "m", "displacement": "m", "velocity": "m s-1", "force_density": "N m-3",
                                             "strain_energy_density": "J m-3", "damage": "1"})
            self.assertEqual(rhexis.rank(), 0)
            largest = numpy.sqrt(sum(component**2 for component in u)).max()
            seen.append((particles.step, particles.time_s, particles.annotations["pressure"], float(largest)))

        results = rhexis.run(VESSEL, SHORT, progress=progress)
        self.assertEqual([step for step, *_ in seen], list(range(0, results["steps"] + 1, 2)))
        self.assertEqual(seen[-1][1], results["simulated_s"])
        self.assertEqual(seen[-1][3], results["max_displacement_m"])
        self.assertGreater(seen[-1][2], seen[0][2])

    def test_progress_that_raises_or_keeps_memory_ends_the_run(self):
        kept = []
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            rhexis.run(VESSEL, SHORT, output=self.folder, progress=lambda particles, network: 1 / 0)
        self.assertIn("progress raised ZeroDivisionError: division by zero", json.loads((self.folder / "run.json").read_text())["status"])
        with self.assertRaisesRegex(ValueError, "copies"):
            rhexis.run(VESSEL, SHORT, progress=lambda particles, network: kept.append(particles["damage"]))
        kept.clear()
        with self.assertRaisesRegex(ValueError, "copies"):
            rhexis.run(VESSEL, SHORT, progress=lambda particles, network: kept.append(particles))
        with self.assertRaisesRegex(rhexis.RunError, "has passed"):
            kept[0]["damage"]
        with self.assertRaises(KeyError):
            rhexis.run(VESSEL, SHORT, progress=lambda particles, network: particles["damge"])
        with self.assertRaisesRegex(rhexis.RunError, "one at a time"):
            rhexis.run(VESSEL, SHORT, progress=lambda *_: rhexis.check(VESSEL))
        self.assertEqual(rhexis.run(VESSEL, SHORT, progress=lambda particles, network: kept.append(particles["damage"].copy()))["steps"], 2 * len(kept[1:]) - 2)

    def test_ctrl_c_saves_the_run(self):
        """In this process: the handler is Python's again afterwards, and the next run is not interrupted."""
        before, watcher = signal.getsignal(signal.SIGINT), threading.Event()

        def interrupt():
            while not (self.folder / "run.json").exists():
                time.sleep(0.01)
            time.sleep(0.2)
            os.kill(os.getpid(), signal.SIGINT)
            watcher.set()

        thread = threading.Thread(target=interrupt)  # which runs, for a run leaves Python to others
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            rhexis.run(VESSEL, LONG, output=self.folder)
        thread.join()
        self.assertTrue(watcher.is_set())
        record = json.loads((self.folder / "run.json").read_text())
        self.assertEqual(record["status"], "failed: interrupted by SIGINT")
        saved = record["results"]["steps"]
        (checkpoint,) = (self.folder / "checkpoints").iterdir()
        self.assertEqual(signal.getsignal(signal.SIGINT), before)
        end = f"{(saved + 10) * record['results']['time_step_s']!r} s"
        again = rhexis.run(VESSEL, LONG | {"time.end": end}, restart=checkpoint)
        at_once = rhexis.run(VESSEL, LONG | {"time.end": end})
        self.assertEqual(again["max_displacement_m"], at_once["max_displacement_m"])
        with self.assertRaises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)

    def test_a_run_ends_by_sigterm_as_python_does(self):
        process = script("print('go', flush=True); rhexis.run(VESSEL, LONG, output=sys.argv[1])", self.folder)
        while not (self.folder / "run.json").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        process.terminate()
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, -signal.SIGTERM)
        self.assertEqual(json.loads((self.folder / "run.json").read_text())["status"], "failed: interrupted by SIGTERM")

    def test_the_process_stays_as_it_was(self):
        """Signals, environment of programs started later and OpenMP's threads."""
        self.output_of("""
            import ctypes, os, signal, subprocess
            openmp = ctypes.CDLL("libgomp.so.1")
            openmp.omp_set_num_threads(3)
            state = lambda: ([signal.getsignal(s) for s in signal.valid_signals()], openmp.omp_get_max_threads(), os.getcwd(),
                             {line for line in subprocess.check_output(["env"], text=True).splitlines() if "OMPI_MCA_sharedfp" not in line})
            import_only = state()
            rhexis.run(VESSEL, SHORT, progress=lambda *_: print(openmp.omp_get_max_threads()))
            assert state() == import_only, (state(), import_only)
            """)

    def test_a_forked_process_is_refused(self):
        out = self.output_of("""
            import multiprocessing
            def check(_):
                try:
                    return rhexis.check(VESSEL, SHORT)["model"]
                except rhexis.RunError as error:
                    return str(error)
            with multiprocessing.get_context("fork").Pool(2) as pool:
                print(pool.map(check, range(2)))
            check(0)
            with multiprocessing.get_context("fork").Pool(1) as pool:
                print(pool.map(check, [0]))
            """)
        first, second = out.splitlines()
        self.assertEqual(first, "['vessel', 'vessel']")
        self.assertIn("before this process was forked", second)

    def test_ranks_make_the_same_calls(self):
        out = self.output_of("print(rhexis.rank(), rhexis.run(VESSEL, SHORT)['max_displacement_m'])", launcher=[*MPIRUN, "-n", "2"])
        alone = rhexis.run(VESSEL, SHORT)["max_displacement_m"]
        self.assertEqual(sorted(out.splitlines()), [f"{rank} {alone!r}" for rank in range(2)])

    def test_one_rank_that_raises_ends_all(self):
        progress = """
            def progress(particles, network):
                if rhexis.rank() == 1:
                    raise KeyError("only here")
            try:
                rhexis.run(VESSEL, SHORT, progress=progress)
            except Exception as error:
                print(rhexis.rank(), type(error).__name__, error)
            """
        out = self.output_of(progress, launcher=[*MPIRUN, "-n", "2"])
        self.assertEqual(sorted(out.splitlines()), ["0 RunError progress raised KeyError: 'only here'", "1 KeyError 'only here'"])
        alone = script("if rhexis.rank() == 1: raise SystemError('alone')\nrhexis.run(VESSEL, LONG)",
                       launcher=[*MPIRUN, "-n", "2"])
        self.assertIn("alone", alone.communicate(timeout=60)[1])
        self.assertNotEqual(alone.returncode, 0)

    def test_the_example(self):
        text = (SOURCE / "examples/probability.py").read_text().replace("range(1, 9)", "range(1, 2)").replace("3 mm", "1.5 mm")
        text = text.replace("COARSE = {", 'COARSE = {"time.end": "5 us", ')
        result = subprocess.run([sys.executable, "-c", text], cwd=SOURCE, env=os.environ | {"PYTHONPATH": FOLDER}, capture_output=True, text=True,
                                timeout=120, check=True)
        self.assertRegex(result.stdout, r"^0 of 1 walls tore")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
