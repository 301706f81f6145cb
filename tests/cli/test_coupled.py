# SPDX-License-Identifier: BSD-3-Clause
"""A vessel of a network, coupled, as a user meets it: wrong input, load, restarts.

Run by ctest as: test_coupled.py RHEXIS MPIRUN...
"""

import math
import os
import sys
import unittest

import h5py
import numpy as np

from coupled_case import ARTERY, BED, BLOOD_DENSITY, FEEDER, JUNCTIONS, MMHG, ONE_WAY, TREE, TWO_WAY, VESSELS, CoupledCase, at_once, changed

SHORT = {"j.csv": JUNCTIONS.replace("brain,4,20,0", "brain,-2,10.3,0"), "v.csv": VESSELS.replace(",6,0.75", ",0.3,0.75")}
PLACELESS = "id,pressure [mmHg]\nheart,200\nneck,\nbrain,\nvein,20\n"
CUFF = '[body]\ncompression = "10 mmHg"\n'

# Those that several ranks find out in different ways: all of them or the first for all, before, after and without the network's solution.
BY_TWO_RANKS = {"id beyond the last", "absent from the file", "rows of a piece", "collapse"}
# name, input, what the message says: file, line, key and value, as a regular expression, and what is allowed; other files
WRONG = [
    ("energy release rate without horizon", changed(TWO_WAY, "critical_stretch", 'energy_release_rate = "1 J/m2"'),
     [r'c\.toml:\d+: material\.energy_release_rate = "1 J/m2": ', "discretisation.horizon"]),
    ("id beyond the last", changed(TREE, "vessel", 'vessel = "8190"'), [r'c\.toml:18: coupling\.vessel = "8190": ', "0 to 8189"]),
    ("path with a two", changed(TREE, "vessel", 'vessel = "artery.0120"'), [r'c\.toml:18: coupling\.vessel = "artery.0120": ', "0 and 1"]),
    ("absent from the file", changed(TWO_WAY, "vessel", 'vessel = "nerve"'), [r'c\.toml:12: coupling\.vessel = "nerve": ', r"v\.csv"]),
    ("no vessel", changed(TWO_WAY, "vessel", ""), [r"c\.toml: coupling\.vessel is missing", "its path in a tree"]),
    ("rows of a piece", changed(TWO_WAY, "spacing", "particles = 1000"), [r"c\.toml:21: discretisation\.particles = 1000: ", "5 spacings", "10 rows"]),
    ("rows of a whole vessel", changed(TWO_WAY, "spacing", "particles = 30000"), [r"c\.toml:21: discretisation\.particles = 30000: ", "10 spacings"], SHORT),
    ("rows without a choice", changed(TWO_WAY, "spacing", ""), [r'c\.toml: discretisation\.particles \(default "auto"\): ', "10 spacings"], SHORT),
    ("shorter than a spacing", changed(TWO_WAY, "spacing", 'spacing = "350 um"'),
     [r"c\.toml:\d+: (coupling\.vessel|discretisation\.spacing) = ", "300 um"], SHORT),
    ("collapse", TWO_WAY + '[body]\ncompression = "300 mmHg"\n', [r"c\.toml:\d+: (body|coupling)\.\w+ = ", "artery", r"Eq\. \(?7", "collapse", r"-1..\.\d mmHg"]),
    ("collapse by tissue", TWO_WAY + '[body]\ntissue_tension = "300 mmHg"\n', [r"c\.toml:\d+: (body|coupling)\.\w+ = ", "artery", "collapse"]),
    ("window below a step", changed(TWO_WAY, "window", 'window = "4 us"'), [r'c\.toml:14: coupling\.window = "4 us": ', "5 us"]),
    ("window beyond the end", changed(TWO_WAY, "window", 'window = "2 ms"'), [r'c\.toml:14: coupling\.window = "2 ms": ', r"time\.end = 1\.6 ms"]),
    ("cuff beyond the body", TWO_WAY + CUFF + 'compression_from = "1 m"\ncompression_to = "2 m"\n',
     [r'c\.toml:37: body\.compression_from = "1 m": ', r"-0\.1 m to 0\.05 m"]),
    ("cuff before the body", TWO_WAY + CUFF + 'compression_to = "-1 m"\n', [r'c\.toml:37: body\.compression_to = "-1 m": ', r"-0\.1 m to 0\.05 m"]),
    ("cuff beyond a tree", TREE + CUFF + 'compression_from = "9 m"\n', [r'c\.toml:30: body\.compression_from = "9 m": ', "reaches from"]),
    ("cuff the wrong way round", TWO_WAY + CUFF + 'compression_from = "2 cm"\ncompression_to = "1 cm"\n',
     [r'c\.toml:38: body\.compression_to = "1 cm": ', "above body.compression_from"]),
    ("cuff without places", TWO_WAY + CUFF + 'compression_from = "0 m"\n',
     [r'c\.toml:37: body\.compression_from = "0 m": ', "coordinates"], {"j.csv": PLACELESS, "v.csv": VESSELS}),
    ("weight without places", TWO_WAY + '[flow]\nacceleration = ["0 m/s2", "9 m/s2", "0 m/s2"]\n',
     [r"c\.toml:36: flow\.acceleration = ", "coordinates"], {"j.csv": PLACELESS, "v.csv": VESSELS}),
    ("distributed file", changed(TWO_WAY, "source", 'source = "file"\ntier = "distributed"'),
     [r'c\.toml:6: network\.tier = "distributed": ', "implicit or explicit"]),
    ("section of a vessel's scene", TWO_WAY + '[vessel]\nlength = "2 mm"\n', [r"c\.toml:35: section \[vessel\]", r'scene\.model = "vessel"', '"coupled"']),
    ("pressure", changed(TWO_WAY, "ramp_time", 'pressure = "10 kPa"'), [r'c\.toml:26: load\.pressure = "10 kPa": ', "network"]),
    ("table", changed(TWO_WAY, "schedule", 'schedule = "table"'), [r'c\.toml:25: load\.schedule = "table": ', "network"]),
    ("flow instead of the pressure behind a bleeding tree", changed(TREE, "outlet_pressure", 'inlet_flow = "1 L/min"').replace(
        "[coupling]", '[coupling]\nmode = "two_way"'), [r"c\.toml: flow\.outlet_pressure ", "needed where a tree bleeds"]),
]


class Coupled(CoupledCase):
    # -- wrong input ---------------------------------------------------------------------------------------------

    def refuse(self, case, ranks, *command):
        """Runs it in a folder of its own; the result, and what it left there."""
        name, text, _, *files = case
        files = {"c.toml": text, "j.csv": JUNCTIONS, "v.csv": VESSELS, **(files[0] if files else {})}
        folder = self.path / f"{name} {ranks}"
        folder.mkdir()
        self.write({folder / file: content for file, content in files.items()})
        result = self.rhexis(*(command or ("run", "c.toml")), ranks=ranks, cwd=folder)
        return result, sorted(set(os.listdir(folder)) - set(files))

    def assert_refused(self, result, left, patterns):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("rhexis: "), 1, f"not one message: {result.stderr}")
        for pattern in patterns:
            self.assertRegex(result.stderr, pattern)
        self.assertEqual(left, [], "something was written")

    def test_wrong_inputs(self):
        cases = [(case, None) for case in WRONG] + [(case, 2) for case in WRONG if case[0] in BY_TWO_RANKS]
        self.assertEqual(len(cases), len(WRONG) + len(BY_TWO_RANKS))
        for (case, ranks), outcome in zip(cases, at_once(self.refuse, cases), strict=True):
            with self.subTest(case[0], ranks=ranks):
                self.assert_refused(*outcome, case[2])
        outcome = self.refuse(("restart", TWO_WAY, []), None, "run", "c.toml", "--restart", "x.h5")
        self.assert_refused(*outcome, [r"x\.h5: .*no such file"])

    def test_check(self):
        self.write({"two_way.toml": TWO_WAY, "tree.toml": TREE})
        before = sorted(os.listdir(self.path))
        for scene, patterns in (("two_way.toml", ["artery", "3,456", "stable", "mmHg"]),
                                ("tree.toml", [r"artery\.0", "3,190", "piece", "stable", "mmHg"])):
            with self.subTest(scene):
                result = self.rhexis("check", scene)
                self.assertEqual(result.returncode, 0, result.stderr)
                for pattern in patterns:
                    self.assertRegex(result.stdout, pattern)
        self.assertEqual(sorted(os.listdir(self.path)), before)
        short = "bears more than the vessel would"
        self.assertIn(short, self.rhexis("check", "tree.toml").stderr)
        self.assertNotIn(short, self.rhexis("check", "tree.toml", "--set", "boundary.ends=axial_periodic").stderr)
        self.assertNotIn(short, self.rhexis("check", "two_way.toml").stderr)
        cuff = next(case for case in WRONG if case[0] == "cuff beyond the body")
        self.assert_refused(*self.refuse(cuff, None, "check", "c.toml"), cuff[2])

    def test_a_cuff_that_does_not_reach_the_vessel_is_told(self):
        self.write({"c.toml": TWO_WAY + '[body]\ncompression = "9 mmHg"\n'})
        for edge, told in (("20 mm", True), ("1 mm", False)):
            result = self.rhexis("check", "c.toml", "--set", f"body.compression_from={edge}")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual("the compression does not reach vessel artery" in result.stderr, told, result.stderr)

    # -- the load ------------------------------------------------------------------------------------------------

    def test_without_flow_it_is_the_standalone_vessel(self):
        """The whole vessel, and the piece of it that the constant-N rule leaves; both tear and are vented."""
        self.write({"j.csv": JUNCTIONS.replace(",20\n", ",200\n")})
        network, wall = ONE_WAY.split("[material]")
        wall = changed(changed(changed(wall, "step", ""), "end", 'end = "0.7 ms"'), "every_steps", "every_steps = 40")
        wall = changed(changed(wall, "critical_stretch", "critical_stretch = 0.01"), "ramp_time", 'ramp_time = "0.2 ms"') + '[boundary]\nends = "sliding"\n'
        area = math.pi * (2.25e-3**2 - 1.5e-3**2)
        for name, particles, spacing in (("whole", 'spacing = "250 um"', "250 um"), ("piece", "particles = 4400", f"{0.75e-3 / 5!r} m")):
            with self.subTest(name):
                c = self.run_well(f"{network}[material]{changed(wall, 'spacing', particles)}", name)
                vessel, length, start = (c["coupling"][key] for key in ("vessel", "simulated_length_m", "simulated_from_m"))
                self.assertEqual(c["coupling"]["net_pressure_Pa"], [200 * MMHG] * 3)
                alone = changed(wall, "spacing", f'spacing = "{spacing}"').replace("[load]", '[load]\npressure = "200 mmHg"')
                radii = vessel["radius_m"], vessel["radius_m"] + vessel["wall_thickness_m"]
                alone = self.run_well('[vessel]\ninner_radius = "{!r} m"\nouter_radius = "{!r} m"\nlength = "{!r} m"\n'.format(*radii, length)
                                      + f"[material]{alone}", "alone")
                self.assertIsNotNone(alone["rupture_onset_s"])
                self.assertLess(self.rows("alone/history.csv")[-1]["pressure_Pa"], 199 * MMHG)
                for key in set(c) - {"network", "coupling"}:
                    self.assertEqual(c[key], alone[key], key)
                self.assertEqual((self.path / name / "history.csv").read_bytes(), (self.path / "alone/history.csv").read_bytes())
                self.assert_same_data(f"{name}/particles.h5", "alone/particles.h5")
        self.assert_close(c["coupling"]["spacing_of_constant_N_m"], (area * 6e-3 / 4400) ** (1 / 3), 1e-12)
        self.assert_close(length, 4400 * 150e-6**3 / area, 1e-12)
        self.assertAlmostEqual(start + length / 2, 3e-3, delta=1e-15)

    def test_a_vessel_of_a_tree(self):
        """What the network says of the vessel is what a plain network scene says; the wall is loaded with it."""
        plain = TREE.split("[discretisation]")[0].replace('model = "coupled"', 'model = "network"').replace("[coupling]", "[network]")
        plain = changed(plain, "vessel", 'query = ["artery.0", "vein.1"]')
        coupled = changed(TREE, "end", 'end = "20 us"')
        weight, ends = "flow.acceleration=['4 m/s2', '-9 m/s2', '2 m/s2']", {}
        runs = [("implicit", [], None), ("explicit", [weight], 2)]
        for (tier, settings, _), p, c in zip(runs, at_once(self.run_well, [(plain, f"plain_{t}", *s, f"network.tier={t}") for t, s, _ in runs]),
                                             at_once(lambda t, s, ranks: self.run_well(coupled, t, *s, f"network.tier={t}", "network.query=['vein.1']",
                                                                                       ranks=ranks), runs)):
            vessel = c["coupling"]["vessel"]
            self.assertEqual(vessel, p["network"]["queries"][0])
            self.assertEqual(c["network"]["queries"], p["network"]["queries"][1:])
            ends[tier] = vessel["pressure_from_Pa"], vessel["pressure_to_Pa"]
            expected = [ends[tier][0], sum(ends[tier]) / 2, ends[tier][1]]
            self.assertGreater(expected[0] - expected[2], 100)
            for net, pressure in zip(c["coupling"]["net_pressure_Pa"], expected, strict=True):
                self.assert_close(net, pressure, 1e-14)
            # The largest on the piece that is simulated, which lies about the middle: at its beginning.
            share = 2 * c["coupling"]["simulated_from_m"] / vessel["length_m"]
            self.assertGreater(share, 0.1)
            largest = expected[0] + share * (expected[1] - expected[0])
            self.assert_close(self.rows(f"{tier}/history.csv")[-1]["pressure_Pa"], largest, 1e-14)
            self.assertFalse((self.path / tier / "coupling.csv").exists())
            for key in ("windows", "leak_m3_s", "leaked_m3", "max_imbalance"):
                self.assertIsNone(c["coupling"][key])
        self.assertGreater(abs(ends["implicit"][0] - ends["explicit"][0]), 10)  # the weight is there

    def test_every_term_of_the_net_pressure(self):
        """Eq. (7); P_g twice: across the direction between heart and vein, and along it, where it changes the flow."""
        flow, places = 180 * MMHG / (FEEDER + ARTERY + BED), (0, 0.5, 1)
        heart = [200 * MMHG - flow * (FEEDER + place * ARTERY) for place in places]
        tension, atmosphere, cuff = 3 * MMHG, -5 * MMHG, 11 * MMHG
        terms = [f"body.{key} mmHg" for key in ("tissue_tension=3", "atmosphere=-5", "compression=11")]
        weight = [-9.81 * BLOOD_DENSITY * (10e-3 + place * 10e-3) for place in places]
        driving = 180 * MMHG + 7 * BLOOD_DENSITY * 0.15  # heart and vein are 150 mm apart
        along = [200 * MMHG + 7 * BLOOD_DENSITY * (0.1 - 2e-3 + place * 6e-3) - driving * flow / (180 * MMHG) * (FEEDER + place * ARTERY)
                 for place in places]
        cases = [([terms[2], "body.compression_from=-1 mm", "body.compression_to=2 mm"], [heart[0], heart[1] - cuff, heart[2]]),
                 ([terms[2], "body.compression_axis=y", "body.compression_to=16 mm"], [heart[0] - cuff, heart[1] - cuff, heart[2]]),
                 (["flow.acceleration=['7 m/s2','0 m/s2','0 m/s2']"], along),
                 ([*terms, "flow.acceleration=['0 m/s2','-9.81 m/s2','3 m/s2']"],
                  [p + g - tension - atmosphere - cuff for p, g in zip(heart, weight)])]
        scene = changed(changed(ONE_WAY, "end", 'end = "20 us"'), "ramp_time", 'ramp_time = "40 us"')
        runs = at_once(self.run_well, [(scene, str(i), "load.schedule=ramp", *settings) for i, (settings, _) in enumerate(cases)])
        for i, ((settings, expected), run) in enumerate(zip(cases, runs)):
            for net, pressure in zip(run["coupling"]["net_pressure_Pa"], expected, strict=True):
                self.assertAlmostEqual(net, pressure, delta=1e-7, msg=settings)
            # Half way up the ramp the wall has half of the largest.
            self.assertAlmostEqual(self.rows(f"{i}/history.csv")[-1]["pressure_Pa"], max(expected) / 2, delta=1e-7)

    def test_a_cuff_is_on_the_body_and_not_on_what_is_shown_of_it(self):
        c = self.run_well(changed(TREE, "end", 'end = "20 us"') + CUFF, "out", "body.compression_from=-400 mm", "body.compression_to=-100 mm",
                          "network.shown_subtree=artery.11111111")["coupling"]
        self.assert_close(c["net_pressure_Pa"][0], c["vessel"]["pressure_from_Pa"] - 10 * MMHG, 1e-14)

    def test_the_load_falls_along_the_vessel(self):
        """A vessel with nearly the whole drop bulges most where blood enters; turned round, the picture is mirrored."""
        def bulge(name, ends):
            self.write({"p.csv": PLACELESS, f"{name}.csv": VESSELS.replace("neck,brain", ends).replace("1.2,300", "1.5,0.6").replace("0.3,50", "1.5,0.6")})
            self.run_well(changed(ONE_WAY, "critical_stretch", ""), name, "time.end=1 ms", "output.every_steps=200", f"network.files=['p.csv', '{name}.csv']")
            with h5py.File(self.path / name / "particles.h5") as file:
                x, u = file["reference_position"][:], file["displacement/000200"][:]
            radial = (x[:, :2] * u[:, :2]).sum(axis=1) / np.hypot(x[:, 0], x[:, 1])
            row = np.rint(x[:, 2] / 250e-6 - 0.5).astype(int)
            return np.bincount(row, radial) / np.bincount(row)

        there, back = at_once(bulge, [("there", "neck,brain"), ("back", "brain,neck")])
        self.assertEqual(len(there), 24)
        self.assertGreater(there[:12].mean() / there[12:].mean(), 1.3)
        np.testing.assert_allclose(there, back[::-1], atol=1e-4 * there.max())

    # -- restarts ------------------------------------------------------------------------------------------------

    def test_restart_goes_on_bit_by_bit(self):
        results = self.run_well(ONE_WAY, "whole", "time.end=1 ms", "output.checkpoint_every=130")
        whole = self.rows("whole/history.csv")
        self.assertGreater(whole[32]["broken_bonds"], 0)  # at step 128
        more = ["--restart", "whole/checkpoints/step_000130.h5"]
        rest = self.run_well(ONE_WAY, "rest", "time.end=1 ms", more=more, ranks=2)
        self.assertEqual(rest, results)
        self.assertEqual(self.rows("rest/history.csv"), whole[33:])
        with h5py.File(self.path / "whole/particles.h5") as a, h5py.File(self.path / "rest/particles_from_000130.h5") as b:
            for field in ("position", "velocity", "damage"):
                self.assertTrue((a[f"{field}/000200"][:] == b[f"{field}/000200"][:]).all(), field)
        # The network's files say what the load is, and the geometry: a checkpoint is of one body.
        self.write({"j.csv": JUNCTIONS.replace("heart,-100,0,0,200", "heart,-100,0,0,230")})
        other = self.rhexis("run", "rest.toml", "-o", "other", "--set", "time.end=1 ms", *more)
        self.assertEqual(other.returncode, 0, other.stderr)
        self.assertIn("warning: the schedule had ", other.stderr)
        self.write({"j.csv": JUNCTIONS, "v.csv": VESSELS.replace(",6,0.75", ",7,0.75")})
        refused = self.rhexis("run", "rest.toml", "-o", "x", *more)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("another body: vessel.length was", refused.stderr)
        self.assertFalse((self.path / "x").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
