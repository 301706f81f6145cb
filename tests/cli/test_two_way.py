# SPDX-License-Identifier: BSD-3-Clause
"""A vessel of a network that bleeds into it: closed form, windows, tiers, ranks.

Run by ctest as: test_two_way.py RHEXIS MPIRUN...
"""

import json
import math
import re
import shutil
import subprocess
import sys
import time
import unittest

import h5py

from coupled_case import (ARTERY, BED, BLOOD_DENSITY, BLOOD_VISCOSITY, DISCHARGE, FEEDER, MMHG, RHEXIS, TREE, TWO_WAY, VESSELS, CoupledCase,
                          at_once, changed)

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


def bleeding(share, factor, opening, outside, weight):
    """The artery as a tube of two halves, with a hole between them, fed through the feeder and drained by the bed.

    `share` of all pressures acts; `factor` is on the artery's resistance; `outside` and `weight` (Eq. 7: tension and
    compression; P_g) hold at its beginning, middle and end. Net pressures there, leak, inflow, outflow, and the larger
    flow at the artery's ends.
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
    return net, leak(p), sum(max(q, 0) for q in flows), sum(max(-q, 0) for q in flows), max(map(abs, flows))


class TwoWay(CoupledCase):
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
        reynolds = {}  # by time
        for row, wall in zip(rows, history):
            share = 0.5 - 0.5 * math.cos(math.pi * min(row["time_s"] / 0.8e-3, 1))
            self.assertAlmostEqual(row["schedule"], share, delta=1e-14)
            net, leak, inflow, outflow, fastest = bleeding(share, row["resistance_factor"], row["opening_m2"], *surroundings)
            reynolds[row["time_s"]] = 2 * BLOOD_DENSITY * fastest / (math.pi * 1.5e-3 * BLOOD_VISCOSITY)
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
        self.assert_close(c["highest_reynolds"], max(reynolds.values()), 1e-9)
        warnings = json.loads((self.path / "out/run.json").read_text())["warnings"]
        [warning] = [text for text in warnings if "Reynolds" in text]
        first = next(time for time, number in reynolds.items() if number > 2300)
        self.assertIn(f"at {1e3 * first:.4g} ms the Reynolds number in the torn vessel has reached {reynolds[first]:.0f};", warning)
        self.assertEqual(c["net_pressure_at_end_Pa"], found)
        for first, expected in zip(c["net_pressure_Pa"], closed, strict=True):
            self.assertAlmostEqual(first, expected, delta=1e-7)
        self.assertLess(abs(results["energy_drift"]), 1e-3)

    def test_what_leaked_is_told_to_the_end(self):
        """Also where the last window is not a whole one: the leak of each row holds until the next, the last to the end."""
        results = self.run_well(TWO_WAY, "odd", "coupling.window=70 us", "output.fields=[]")
        rows = self.rows("odd/coupling.csv")
        ends = [row["time_s"] for row in rows[1:]] + [results["simulated_s"]]
        self.assertGreater(ends[-1], rows[-1]["time_s"])
        leaked = sum(row["leak_m3_s"] * (end - row["time_s"]) for row, end in zip(rows, ends, strict=True))
        self.assert_close(results["coupling"]["leaked_m3"], leaked, 1e-12)

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

    def test_tiers_agree(self):
        runs = at_once(self.run_well, [(TORN_TREE, tier, f"network.tier={tier}", "material.young_modulus=1 MPa", "material.critical_stretch=2")
                                       for tier in ("implicit", "explicit")])
        self.assertLess(self.rows("implicit/coupling.csv")[-1]["resistance_factor"], 0.99)
        for one, other in zip(*(run["coupling"]["net_pressure_at_end_Pa"] for run in runs), strict=True):
            self.assert_close(one, other, 1e-9)

    def test_restart_goes_on_bit_by_bit(self):
        """Within a window before the wall breaks, at a window's end while it tears; on other numbers of ranks."""
        scene = changed(TWO_WAY, "end", 'end = "1 ms"')
        results = self.run_well(scene, "whole", "output.checkpoint_every=66")
        self.assertGreater(results["coupling"]["leaked_m3"], 0)
        self.assertGreater(self.rows("whole/history.csv")[33]["broken_bonds"], 0)
        for step, ranks in ((66, 4), (132, 2)):
            folder = f"from_{step}"
            shutil.copytree(self.path / "whole", self.path / folder)
            rest = self.run_well(scene, folder, more=["--restart", f"{folder}/checkpoints/step_{step:06d}.h5"], ranks=ranks)
            self.assertEqual(rest, results)
            for file in ("history.csv", "coupling.csv", "vessels.csv"):
                self.assertEqual((self.path / folder / file).read_bytes(), (self.path / "whole" / file).read_bytes(), (step, file))
            with h5py.File(self.path / "whole/particles.h5") as a, h5py.File(self.path / folder / f"particles_from_{step:06d}.h5") as b:
                for field in ("position", "velocity", "damage"):
                    self.assertEqual(a[f"{field}/000200"][()].tobytes(), b[f"{field}/000200"][()].tobytes(), field)
        self.assert_other_networks_are_refused(scene, "whole/checkpoints/step_000132.h5")

    def test_a_moment_that_cannot_be_stored_is_gone_on_from(self):
        """Though the network has answered to it already: an exchange that is done anew counts once."""
        scene = changed(TWO_WAY, "end", 'end = "1 ms"')
        results = self.run_well(scene, "whole")
        self.write({"cut.toml": scene})
        history = self.path / "cut/history.csv"
        with subprocess.Popen([RHEXIS, "run", "cut.toml", "-o", "cut"], cwd=self.path, stdout=subprocess.PIPE, text=True) as run:
            while run.poll() is None and not (history.exists() and history.read_text().count("\n") > 3):
                time.sleep(0.001)
            history.unlink()
            said = run.communicate(timeout=120)[0]
        self.assertEqual(run.returncode, 3)
        checkpoint = re.search(r"failed; go on with --restart (\S+)", said).group(1)
        last = self.rows("cut/coupling.csv")[-1]["time_s"]
        rest = self.run_well(scene, "cut", more=["--restart", checkpoint])
        self.assertAlmostEqual(last, int(re.search(r"(\d+)\.h5", checkpoint).group(1)) * results["time_step_s"], delta=1e-12)
        self.assertEqual(rest, results)
        self.assertEqual((self.path / "cut/coupling.csv").read_bytes(), (self.path / "whole/coupling.csv").read_bytes())

    def assert_other_networks_are_refused(self, scene, checkpoint):
        self.write({"scene.toml": scene, "wide.csv": VESSELS.replace("0.3,50", "0.31,50"), "other.csv": VESSELS.replace("artery,neck", "nerve,neck")})
        for settings, what in ((["network.files=['j.csv','wide.csv']"], "the network is not as it was: its inflow was "),
                               (["network.files=['j.csv','other.csv']", "coupling.vessel=nerve"], "the chosen vessel was artery, and now is nerve"),
                               (["coupling.mode=one_way"], 'coupling.mode was "two_way", and now is "one_way"'),
                               (["cascade.events=2"], "not of a cascade")):
            with self.subTest(what):
                words = [word for setting in settings for word in ("--set", setting)]
                refused = self.rhexis("run", "scene.toml", "-o", "x", "--restart", checkpoint, *words)
                self.assertEqual(refused.returncode, 2, refused.stderr)
                self.assertIn(checkpoint, refused.stderr)
                self.assertIn(what, refused.stderr)
                self.assertFalse((self.path / "x").exists())
        told = self.rhexis("run", "scene.toml", "-o", "x", "--restart", checkpoint, "--set", "coupling.window=40 us", "--set", "time.end=0.7 ms")
        self.assertIn('coupling.window was "20 us", and now is "40 us", from step 132 on', told.stderr)

    def test_a_damaged_table_is_refused_at_a_restart(self):
        self.run_well(TWO_WAY, "out", "time.end=0.1 ms", "output.checkpoint_every=10")
        restart = ["run", "out.toml", "-o", "out", "--restart", "out/checkpoints/step_000010.h5"]
        for file, damage in (("history.csv", lambda rows: rows[:2] + ["x" + rows[2]] + rows[3:]), ("coupling.csv", lambda rows: rows[:3] + rows[2:])):
            path = self.path / "out" / file
            whole, before = path.read_text(), (self.path / "out/run.json").read_bytes()
            path.write_text("".join(damage(whole.splitlines(True))))
            refused = self.rhexis(*restart)
            self.assertEqual(refused.returncode, 2, refused.stderr)
            self.assertRegex(refused.stderr, rf"out/{file}:[34]: a damaged row: ")
            self.assertEqual((self.path / "out/run.json").read_bytes(), before)
            path.write_text(whole)

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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
