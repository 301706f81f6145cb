# SPDX-License-Identifier: BSD-3-Clause
"""Every ending of a run leaves a true record: signals, a terminal or files that cannot be written, dead ranks.

Run by ctest as: test_endings.py RHEXIS MPIRUN...
"""

import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import time
import unittest

from coupled_case import JUNCTIONS, ONE_WAY, VESSELS, changed
from vessel_case import MPIRUN, RHEXIS, VesselCase, replaced

# Two million steps; without particles.h5, which would have room for all.
LONG = replaced("end", 'end = "1 s"') + "fields = []\n"
SIGNALS = ["SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGXCPU"]


class Endings(VesselCase):
    def setUp(self):
        super().setUp()
        self.write(LONG)

    def start(self, folder, *more, ranks=None, file="vessel.toml", **options):
        """A run at work: its first rows are there."""
        launcher = [*MPIRUN, "-n", str(ranks)] if ranks else []
        process = subprocess.Popen([*launcher, RHEXIS, "run", file, "-o", folder, *more], cwd=self.folder.name,
                                   **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL,
                                      "text": True, **options})
        self.addCleanup(process.kill)
        self.wait_for(lambda: self.rows(folder) > 2)
        return process

    def wait_for(self, condition):
        for _ in range(2400):
            if condition():
                return
            time.sleep(0.05)
        self.fail("waited for two minutes")

    def rows(self, folder):
        try:
            return len(self.history(folder))
        except FileNotFoundError:
            return 0

    def end(self, process, status):
        """What a run that ends by itself says, on both streams."""
        out, error = process.communicate(timeout=120)
        self.assertEqual(process.returncode, status, error)
        return (out or "") + (error or "")

    def status(self, folder):
        self.assertEqual([str(path) for path in pathlib.Path(self.path(folder)).rglob("*")
                          if path.suffix == ".part" or re.search(r"\.[0-9a-f]{16}-[0-9]+$", path.name)], [])
        return self.record(folder)["status"]

    def last_checkpoint(self, folder):
        return max(pathlib.Path(self.path(folder), "checkpoints").glob("step_*.h5"))

    def ranks_of(self, launcher):
        """Process ids, by rank, of a run under mpirun."""
        ranks = {}
        for path in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if f"\nPPid:\t{launcher.pid}\n" not in (path / "status").read_text():
                    continue
                environment = dict(entry.split("=", 1) for entry in (path / "environ").read_text().split("\0") if "=" in entry)
                ranks[int(environment["OMPI_COMM_WORLD_RANK"])] = int(path.name)
            except (OSError, KeyError):
                pass
        return ranks

    # -- signals ---------------------------------------------------------------------------------------------------

    def test_signals_leave_a_checkpoint(self):
        for name in SIGNALS:
            process = self.start(name)
            number = getattr(signal, name)
            process.send_signal(number)
            said = self.end(process, 128 + number)
            self.assertEqual(self.status(name), f"failed: interrupted by {name}")
            last = int(self.history(name)[-1]["step"])
            self.assertEqual(self.record(name)["results"]["steps"], last)
            self.assertEqual(self.last_checkpoint(name).name, f"step_{last:06d}.h5")
            self.assertIn(f"--restart {name}/checkpoints/step_{last:06d}.h5", said)

    def test_launchers_pass_signals_on(self):
        process = self.start("out", "--quiet", ranks=2)
        process.send_signal(signal.SIGUSR1)
        out, error = process.communicate(timeout=120)
        self.assertNotEqual(process.returncode, 0)
        self.assertEqual(out, "")
        self.assertEqual(self.status("out"), "failed: interrupted by SIGUSR1")
        self.assertIn(f"--restart out/checkpoints/{self.last_checkpoint('out').name}", error)

    def test_what_nohup_ignores_stays_ignored(self):
        process = self.start("out", preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        process.send_signal(signal.SIGHUP)
        before = self.rows("out")
        self.wait_for(lambda: self.rows("out") > before + 2)
        process.send_signal(signal.SIGTERM)
        self.end(process, 143)
        self.assertEqual(self.status("out"), "failed: interrupted by SIGTERM")

    def interrupted_at_once(self, folder, *names):
        """Signals that come together, and what the run says."""
        process = self.start(folder)
        process.send_signal(signal.SIGSTOP)
        for name in names:
            process.send_signal(getattr(signal, name))
        process.send_signal(signal.SIGCONT)
        out, error = process.communicate(timeout=120)
        return process.returncode, out + error

    def test_a_second_signal_changes_nothing_and_a_third_ends_at_once(self):
        code, said = self.interrupted_at_once("two", "SIGINT", "SIGTERM")
        self.assertIn(code, (130, 143), said)
        self.assertIn("a third Ctrl-C or kill ends it at once", said)
        self.assertRegex(self.status("two"), "^failed: interrupted by SIG(INT|TERM)$")
        self.assertEqual(self.last_checkpoint("two").name, f"step_{int(self.history('two')[-1]['step']):06d}.h5")
        code, said = self.interrupted_at_once("three", "SIGINT", "SIGTERM", "SIGHUP")
        self.assertIn(code, (129, 130, 143), said)
        self.assertTrue(self.status("three").startswith("failed: interrupted by SIG"))
        # However often they come, notices of an end that is still some time ahead do not hasten it.
        code, said = self.interrupted_at_once("notices", "SIGUSR1", "SIGXCPU", "SIGTERM")
        self.assertIn(code, (128 + signal.SIGUSR1, 128 + signal.SIGXCPU, 143), said)
        self.assertIn("go on with --restart", said)

    def test_a_coupled_run_saves_its_wall(self):
        for name, text in (("j.csv", JUNCTIONS), ("v.csv", VESSELS), ("c.toml", changed(changed(ONE_WAY, "end", 'end = "1 s"'), "precision", "fields = []"))):
            self.write(text, name)
        process = self.start("out", file="c.toml")
        process.send_signal(signal.SIGTERM)
        self.assertIn("--restart out/checkpoints", self.end(process, 143))
        self.assertEqual(self.status("out"), "failed: interrupted by SIGTERM")

    # -- ranks that die ----------------------------------------------------------------------------------------------

    def test_a_killed_rank_is_told_by_the_others(self):
        process = self.start("out", ranks=2)
        os.kill(self.ranks_of(process)[1], signal.SIGKILL)
        process.communicate(timeout=120)
        self.assertNotEqual(process.returncode, 0)
        status = self.status("out")
        self.assertTrue(status.startswith("failed: interrupted by SIGTERM"), status)
        self.assertIsNotNone(self.record("out")["results"]["steps"])

    def test_a_run_that_was_killed_is_told_by_the_next(self):
        process = self.start("out", "--set", "output.checkpoint_every=20")
        self.wait_for(lambda: list(pathlib.Path(self.path("out/checkpoints")).glob("step_*.h5")))
        busy = self.rhexis("check", "vessel.toml", "-o", "out")
        self.assertIn("a run into out is at work now", busy.stdout)
        process.kill()
        process.communicate()
        self.assertEqual(self.record("out")["status"], "running")
        checkpoint = self.last_checkpoint("out").name
        told = f"the run into out ended without a word (killed, out of memory, or out of power); its last checkpoint, to --restart from, is out/checkpoints/{checkpoint}"
        self.assertIn(told, self.rhexis("check", "vessel.toml", "-o", "out").stdout)
        for folder in ("elsewhere", "out"):
            step = int(checkpoint[5:-3])
            again = self.rhexis("run", "vessel.toml", "-o", folder, "--restart", f"out/checkpoints/{checkpoint}",
                                "--set", f"time.end={(step + 4) * 0.5} us", ranks=2 if folder == "out" else None)
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertIn(told, again.stderr)
            self.assertEqual(self.record(folder)["warnings"], [told])
            self.assertEqual(self.status(folder), "completed")
        self.assertNotIn("without a word", self.rhexis("check", "vessel.toml", "-o", "out").stdout)

    # -- a terminal that cannot be written -----------------------------------------------------------------------------

    def test_a_closed_pipe_costs_no_run(self):
        self.write(replaced("end", 'end = "500 us"'))
        process = subprocess.Popen([RHEXIS, "run", "vessel.toml", "-o", "out"], cwd=self.folder.name, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        process.stdout.readline()
        process.stdout.close()
        error = process.stderr.read()
        process.stderr.close()
        self.assertEqual(process.wait(timeout=120), 0, error)
        self.assertEqual(self.status("out"), "completed")
        self.assertEqual(self.record("out")["warnings"], [
            "stdout could not be written (Broken pipe): what the run said there is lost, its results are not"])

    def test_a_full_or_closed_terminal_costs_no_run(self):
        self.write(replaced("end", 'end = "10 us"'))
        for folder, ranks in (("full", None), ("closed", None), ("two_full", 2)):
            launcher = [*MPIRUN, "-n", "2"] if ranks else []
            close = {"preexec_fn": lambda: os.close(1)} if folder == "closed" else {}
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([*launcher, RHEXIS, "run", "vessel.toml", "-o", folder], cwd=self.folder.name, stdin=subprocess.DEVNULL,
                                      stdout=full, stderr=full if folder == "full" else subprocess.PIPE, timeout=120, check=False, **close)
            self.assertEqual(self.status(folder), "completed")
            if ranks:  # mpirun stands between
                continue
            self.assertEqual(done.returncode, 0)
            self.assertIn("Bad file descriptor" if folder == "closed" else "No space left on device", self.record(folder)["warnings"][0])

    def test_what_prints_alone_fails_where_it_cannot(self):
        for arguments in (["check", "vessel.toml"], ["keys"], ["--version"], ["--help"]):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([RHEXIS, *arguments], cwd=self.folder.name, stdout=full, stderr=subprocess.PIPE, text=True,
                                      timeout=120, check=False)
            self.assertEqual((done.returncode, done.stderr), (3, "rhexis: stdout could not be written: No space left on device\n"), arguments)

    # -- files that cannot be written ----------------------------------------------------------------------------------

    def test_a_limit_on_the_size_of_files_is_a_failure_that_names_the_file(self):
        process = self.start("out", "--set", "time.end=5 ms", "--set", 'output.fields=["damage"]')
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (100_000, 100_000))
        said = self.end(process, 3)
        # The first step beyond the limit is reserved for, or written, before the next.
        why = r"out/particles\.h5: cannot (reserve disk space: File too large|write )"
        self.assertRegex(said, "rhexis: " + why)
        self.assertIn("no checkpoint: out/checkpoints/", said)
        self.assertRegex(self.status("out"), "^failed: " + why)

    def test_files_that_are_taken_away_are_missed(self):
        for ranks in (None, 2):
            for name, take in (("history.csv", os.remove), ("particles.h5", os.remove),
                               ("history.csv", lambda path: (os.remove(path), pathlib.Path(path).write_text("mine", encoding="utf-8")))):
                folder = f"{name}{ranks}{take is os.remove}"
                more = ["--set", "time.end=5 ms", "--set", 'output.fields=["damage"]'] if name == "particles.h5" else []
                process = self.start(folder, *more, ranks=ranks)
                take(self.path(f"{folder}/{name}"))
                out, error = process.communicate(timeout=120)
                self.assertEqual(process.returncode, 3, error)
                why = f"{folder}/{name}: has been " + ("taken away" if take is os.remove else "replaced by another")
                if name == "particles.h5":  # the step before may have been on its way to the disk
                    why = f"{folder}/{name}: (has been taken away|cannot open the file)"
                self.assertRegex(error, "rhexis: " + why)
                self.assertRegex(self.status(folder), "^failed: " + why)
                checkpoint = self.last_checkpoint(folder)
                self.assertIn(f"--restart {folder}/checkpoints/{checkpoint.name}", out)
                if take is not os.remove:
                    self.assertEqual(pathlib.Path(self.path(f"{folder}/{name}")).read_text(encoding="utf-8"), "mine")
        # Such a checkpoint is as good as any.
        step = int(checkpoint.name[5:-3])
        end = ["--set", f"time.end={(step + 40) * 0.5} us", "--set", "output.every_steps=1"]
        for folder, more in (("whole", []), ("rest", ["--restart", str(checkpoint)])):
            self.assertEqual(self.rhexis("run", "vessel.toml", "-o", folder, *end, *more).returncode, 0)
        self.assertEqual(self.history("whole")[-40:], self.history("rest")[-40:])

    def test_a_folder_that_is_taken_away_is_missed(self):
        process = self.start("out")
        os.rename(self.path("out"), self.path("moved"))
        os.mkdir(self.path("out"))
        pathlib.Path(self.path("out/mine")).write_text("", encoding="utf-8")
        said = self.end(process, 3)
        self.assertIn("out/history.csv: has been taken away", said)
        self.assertEqual(os.listdir(self.path("out")), ["mine"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
