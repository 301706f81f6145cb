# SPDX-License-Identifier: BSD-3-Clause
"""Interrupts, checkpoints, and restarts from them.

Run by ctest as: test_restart.py RHEXIS MPIRUN...
"""

import os
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy

from vessel_case import RHEXIS, VesselCase, replaced


class Restart(VesselCase):
    def test_interrupt_saves_and_restart_goes_on_bit_by_bit(self):
        self.write(replaced("end", 'end = "1 ms"'))
        self.assertEqual(self.rhexis("run", "vessel.toml", "-o", "whole", "--set", "time.end=200 us",
                                     "--set", "output.checkpoint_every=150").returncode, 0)
        go_on = self.rhexis("run", "vessel.toml", "-o", "rest", "--set", "time.end=200 us", "--restart",
                            "whole/checkpoints/step_000150.h5", ranks=2)
        self.assertEqual(go_on.returncode, 0, go_on.stderr)
        self.assertEqual(self.history("whole")[-1], self.history("rest")[-1])
        checkpoint = "whole/checkpoints/step_000150.h5"
        self.assertIn(f"restart     from step 150 (75 us) of {checkpoint}", go_on.stdout)
        record = self.record("rest")
        self.assertEqual((record["checkpoint"], record["first_step"]), (checkpoint, 150))
        self.assertEqual(record["warnings"], [])
        self.assertEqual((self.record("whole")["checkpoint"], self.record("whole")["first_step"]), (None, None))
        with h5py.File(self.path("whole/particles.h5")) as a, h5py.File(
                self.path("rest/particles_from_000150.h5")) as b:
            self.assertTrue((a["position/000400"][:] == b["position/000400"][:]).all())

        process = subprocess.Popen([RHEXIS, "run", "vessel.toml", "-o", "cut"], cwd=self.folder.name,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for _ in range(600):
            if os.path.exists(self.path("cut/history.csv")) and len(self.history("cut")) > 2:
                break
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130)
        self.assertIn("--restart", output)
        record = self.record("cut")
        self.assertEqual(record["status"], "failed: interrupted by SIGINT")
        last = int(self.history("cut")[-1]["step"])
        self.assertEqual(last, record["results"]["steps"])
        self.assertTrue(os.path.exists(self.path(f"cut/checkpoints/step_{last:06d}.h5")))
        for file, more, why in (("absent.h5", [], "no such file"),
                                (checkpoint, ["--set", "time.step=400 ns"], "time.step"),
                                (checkpoint, ["--set", "vessel.length=3 mm"],
                                 'another body: vessel.length was "2 mm", and now is "3 mm"'),
                                (checkpoint, ["--set", "boundary.ends=free"], "boundary.ends"),
                                (checkpoint, ["--set", "time.end=50 us"], "time.end")):
            refused = self.rhexis("run", "vessel.toml", "-o", "x", "--restart", file, *more)
            self.assertEqual(refused.returncode, 2, refused.stderr)
            self.assertIn(file, refused.stderr)
            self.assertIn(why, refused.stderr)
            self.assertFalse(os.path.exists(self.path("x")))
        # Another load is a user's right, and is told.
        other = self.rhexis("run", "vessel.toml", "-o", "other", "--set", "time.end=80 us", "--restart", checkpoint,
                            "--set", "load.pressure=200 kPa")
        self.assertEqual(other.returncode, 0, other.stderr)
        told = 'load.pressure was "238 kPa", and now is "200 kPa", from step 150 on'
        self.assertIn(told, other.stderr)
        jump = "the schedule had 178.5 kPa at step 150, and now has 150 kPa"
        self.assertEqual(self.record("other")["warnings"], [told, jump])

    def test_the_checkpoint_of_the_last_step_ends_a_run_that_was_killed_there(self):
        self.write(replaced("end", 'end = "50 us"'))
        more = ("--set", "output.checkpoint_every=100")
        self.assertEqual(self.rhexis("run", "vessel.toml", "-o", "out", *more).returncode, 0)
        whole, history = self.record("out")["results"], self.history("out")
        self.assertEqual(whole["steps"], 100)
        ended = self.rhexis("run", "vessel.toml", "-o", "out", *more, "--restart", "out/checkpoints/step_000100.h5")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual(self.record("out")["results"], whole)
        self.assertEqual(self.history("out"), history)

    def test_an_interrupt_in_the_last_step_is_too_late(self):
        if "Catalyst" not in self.rhexis("--version").stdout:
            self.skipTest("built without ParaView")
        with open(self.path("stop.py"), "w", encoding="utf-8") as file:
            file.write("import os, signal\ndef catalyst_execute(info):\n"
                       "    if info.timestep == 9:\n        os.kill(os.getpid(), signal.SIGINT)\n")
        self.write(replaced("end", 'end = "5 us"') + '[insitu]\nscripts = ["stop.py"]\nevery_steps = 1\n')
        result = self.rhexis("run", "vessel.toml", "-o", "out")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.record("out")["status"], "completed")
        self.assertEqual(os.listdir(self.path("out/checkpoints")), [])
        cut = self.rhexis("run", "vessel.toml", "-o", "out", "--set", "time.end=5.5 us")
        self.assertEqual(cut.returncode, 130, cut.stderr)
        self.assertTrue(os.path.exists(self.path("out/checkpoints/step_000010.h5")))

    def test_many_spots_fit_into_a_checkpoint(self):
        spots = "".join(f'[[spot]]\nposition = "1 mm"\nangle = "{0.5 * i} deg"\nradius = "0.2 mm"\nstiffness = 0.99\n'
                        for i in range(700))
        self.write(replaced("end", 'end = "20 us"') + spots)
        for more in (["--set", "output.checkpoint_every=20"], ["--restart", "out/checkpoints/step_000020.h5"]):
            result = self.rhexis("run", "vessel.toml", "-o", "out", *more)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_restart_draws_the_same_wall(self):
        self.write(replaced("end", 'end = "200 us"') + '[material]\ncritical_stretch = 0.1\n'
                   '[scatter]\ncritical_stretch = 0.1\nstiffness = 0.1\n'
                   '[[spot]]\nposition = "1 mm"\nangle = "90 deg"\nradius = "0.5 mm"\nthickness = 0.5\n')
        whole = self.rhexis("run", "vessel.toml", "-o", "whole", "--set", "output.checkpoint_every=150")
        self.assertEqual(whole.returncode, 0, whole.stderr)
        checkpoint = "whole/checkpoints/step_000150.h5"
        go_on = self.rhexis("run", "vessel.toml", "-o", "rest", "--restart", checkpoint, ranks=2)
        self.assertEqual(go_on.returncode, 0, go_on.stderr)
        last, again = self.history("whole")[-1], self.history("rest")[-1]
        self.assertGreater(int(last["broken_bonds"]), 100)
        self.assertEqual(last, again)
        with h5py.File(self.path("whole/particles.h5")) as a, h5py.File(
                self.path("rest/particles_from_000150.h5")) as b:
            damage = a["damage/000400"][:]
            numpy.testing.assert_array_equal(damage, b["damage/000400"][:])
            numpy.testing.assert_array_equal(a["position/000400"][:], b["position/000400"][:])
        absent = int(numpy.isnan(damage).sum())
        self.assertGreater(absent, 20)
        self.assertEqual(self.record("whole")["results"]["particles"], damage.size - absent)
        self.assertEqual(self.record("whole")["input"]["spot[1]"]["thickness"]["value"], 0.5)
        for other in ("scatter.seed=2", "spot[1].thickness=0.6"):
            refused = self.rhexis("run", "vessel.toml", "-o", "x", "--restart", checkpoint, "--set", other)
            self.assertEqual(refused.returncode, 2, refused.stderr)
            self.assertIn("another body", refused.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
