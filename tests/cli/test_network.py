# SPDX-License-Identifier: BSD-3-Clause
"""The program on networks, as a user meets it: flows, statistics, records, tables, ranks.

Run by ctest as: test_network.py RHEXIS SOURCE_DIR MPIRUN...
"""

import csv
import os
import signal
import subprocess
import sys
import time
import unittest

from network_case import FILES, JUNCTIONS, RHEXIS, SOURCE, TREE, VESSELS, NetworkCase, tree


class Network(NetworkCase):
    def test_tiers_and_ranks_agree(self):
        self.write("n.toml", TREE)
        self.run_well("n.toml", "-o", "one")
        one = self.record("one")["results"]["network"]
        self.assertEqual((one["vessels"], one["junctions"], one["solver"]), (8190, 6144, "recursion"))
        self.assertLess(one["max_imbalance"], 1e-14)
        self.run_well("n.toml", "-o", "two", ranks=2)
        self.assertEqual(self.record("two")["results"]["network"], one)  # to the last bit
        for name in ("generations.csv", "histograms.csv"):
            self.assertEqual((self.path / "one" / name).read_text(), (self.path / "two" / name).read_text())
        for tier, ranks in (("explicit", None), ("explicit", 2), ("distributed", None), ("distributed", 3)):
            self.run_well("n.toml", "-o", "other", "--set", f"network.tier={tier}", ranks=ranks)
            other = self.record("other")["results"]["network"]
            for key in ("vessels", "junctions"):
                self.assertEqual(other[key], one[key], (tier, key))
            for key in ("inflow_m3_s", "volume_m3", "surface_m2"):
                self.assertAlmostEqual(other[key] / one[key], 1, delta=1e-11, msg=(tier, key))
            for a, b in zip(one["queries"], other["queries"], strict=True):
                self.assertEqual((a["name"], a["vessel"], a["kind"]), (b["name"], b["vessel"], b["kind"]))
                self.assertAlmostEqual(a["flow_m3_s"] / b["flow_m3_s"], 1, delta=1e-10)
                self.assertAlmostEqual(a["pressure_from_Pa"], b["pressure_from_Pa"], delta=1e-6)

    def test_ranks_without_vessels_and_answers_for_all(self):
        """More ranks than vessels, without coordinates, too; a query is answered alike whoever has the vessel."""
        self.write("n.toml", FILES)
        self.write("j.csv", JUNCTIONS)
        self.write("v.csv", VESSELS)
        keys = ["--set", "network.query=['2']", "--set", "weakness.strength_spread=0.2"]
        queries = []
        for tier, ranks in (("explicit", None), ("distributed", 1), ("distributed", 2), ("distributed", 3)):
            self.run_well("n.toml", "-o", "out", *keys, "--set", f"network.tier={tier}", ranks=ranks)
            queries.append(self.record("out")["results"]["network"]["queries"][0])
        self.assertNotEqual(queries[0]["strength_factor"], 1)
        self.assertEqual(queries[0]["end_m"], [0.003, 0.004, 0.012])
        for other in queries[1:]:
            for key in ("name", "vessel", "radius_m", "strength_factor", "start_m", "end_m"):
                self.assertEqual(other[key], queries[0][key], key)
        self.write("n.toml", TREE)
        strengths = set()
        for tier, ranks in (("implicit", None), ("explicit", None), ("distributed", 2)):
            self.run_well("n.toml", "-o", "tree", *keys[2:], "--set", f"network.tier={tier}", ranks=ranks)
            strengths.add(tuple(q["strength_factor"] for q in self.record("tree")["results"]["network"]["queries"]))
        self.assertEqual(len(strengths), 1, strengths)
        self.assertNotIn(1, strengths.pop())
        self.write("n.toml", FILES)
        self.write("j.csv", "id,pressure [mmHg]\na,10\nb,\nc,0\n")
        self.write("v.csv", "id,from,to,radius [um],length [mm]\n1,a,b,50,5\n2,b,c,40,12\n")
        for ranks in (2, 3):
            self.run_well("n.toml", "-o", "bare", "--set", "network.tier=distributed", ranks=ranks)
            self.assertEqual(self.record("bare")["results"]["network"]["vessels"], 2)

    def test_statistics_count_every_vessel(self):
        self.write("n.toml", TREE)
        self.run_well("n.toml", "-o", "out")
        with open(self.path / "out/generations.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 24)
        inflow = self.record("out")["results"]["network"]["inflow_m3_s"]
        for row in rows:
            self.assertAlmostEqual(float(row["mean_flow_m3_s"]) * int(row["vessels"]) / inflow, 1, delta=1e-12)
        with open(self.path / "out/histograms.csv", encoding="utf-8") as file:
            counts = {}
            for row in csv.DictReader(file):
                self.assertLess(float(row["from"]), float(row["to"]))
                key = (row["generation"], row["kind"], row["quantity"])
                counts[key] = counts.get(key, 0) + int(row["vessels"])
        self.assertEqual(len(counts), 12 * 5)
        for (generation, _, _), count in counts.items():
            self.assertEqual(count, 2 ** int(generation))

    def test_stored_lines(self):
        import h5py

        self.write("n.toml", TREE)
        self.run_well("n.toml", "-o", "out")
        with h5py.File(self.path / "out/network.h5") as file:
            lines = file["connectivity"][:]
            position, pressure = file["position"][:], file["pressure/000000"][:]
            flow, kind = file["flow/000000"][:], file["kind/000000"][:]
        self.assertEqual(len(lines), 300)
        self.assertEqual(sorted(set(kind)), [0, 1])
        self.assertTrue((flow > 0).all())
        self.assertTrue((pressure[lines[:, 0]] >= pressure[lines[:, 1]]).all())  # blood runs downhill along every line
        self.assertTrue((position[lines[kind == 0], 0] <= 0).all() and (position[lines[kind == 1], 0] >= 0).all())

    def test_stored_lines_of_all_ranks_name_their_vessels(self):
        import h5py

        self.write("n.toml", TREE)
        seen = []
        for tier, ranks in (("explicit", None), ("distributed", 2)):
            self.run_well("n.toml", "-o", tier, "--set", f"network.tier={tier}", "--set", "network.shown_vessels=10000",
                          ranks=ranks)
            with h5py.File(self.path / tier / "network.h5") as file:
                vessel, radius = file["vessel/000000"][:], file["radius/000000"][:]
            self.assertEqual(len(set(vessel)), len(vessel))
            seen.append(dict(zip(vessel, radius)))
        self.assertEqual(*seen)

    def test_gravity_adds_the_weight_of_blood_and_leaves_flow_alone(self):
        self.write("j.csv", JUNCTIONS)
        self.write("v.csv", VESSELS)
        self.write("n.toml", FILES + 'query = ["1", "2"]\n')
        self.run_well("n.toml", "-o", "still")
        # Along z only the second vessel rises, by 12 mm; the lower condition is given at its own height.
        self.run_well("n.toml", "-o", "up", "--set", "flow.acceleration=['0 m/s2', '0 m/s2', '-9.81 m/s2']",
                      "--set", "blood.density=1000 kg/m3")
        weight = 1000 * 9.81 * 12e-3
        still, up = (self.record(f)["results"]["network"] for f in ("still", "up"))
        drop = 10 * 133.322387415
        self.assertAlmostEqual(up["inflow_m3_s"] / still["inflow_m3_s"], (drop - weight) / drop, delta=1e-9)
        self.assertAlmostEqual(up["queries"][1]["pressure_to_Pa"], 0, delta=1e-6)
        self.assertAlmostEqual(up["queries"][0]["pressure_from_Pa"], drop, delta=1e-6)

    def test_published_circle_of_willis(self):
        self.run_well(os.path.join(SOURCE, "inputs/circle_of_willis.toml"), "-o", "out", "--set", "insitu.enabled=false")
        network = self.record("out")["results"]["network"]
        self.assertEqual((network["vessels"], network["junctions"]), (33, 30))
        self.assertLess(network["max_imbalance"], 1e-10)
        with open(self.path / "out/vessels.csv", encoding="utf-8") as file:
            flow = {row["vessel"]: float(row["flow_m3_s"]) for row in csv.DictReader(file)}
        # What enters the circle leaves it through its six arteries to the brain.
        inflow = sum(flow[v] for v in ("left internal carotid I", "right internal carotid I", "basilar"))
        out = sum(flow[f"{side} {v}"] for side in ("left", "right")
                  for v in ("middle cerebral", "anterior cerebral A2", "posterior cerebral P2"))
        self.assertAlmostEqual(inflow / out, 1, delta=1e-9)
        self.assertLess(abs(flow["anterior communicating"]), 0.1 * flow["left middle cerebral"])

    def test_phase_separation_gives_every_vessel_its_haematocrit(self):
        self.run_well(os.path.join(SOURCE, "inputs/own_network.toml"), "-o", "out", "--set", "insitu.enabled=false")
        with open(self.path / "out/vessels.csv", encoding="utf-8") as file:
            rows = {row["vessel"]: row for row in csv.DictReader(file)}
        haematocrits = [float(row["haematocrit"]) for row in rows.values()]
        self.assertLess(min(haematocrits), 0.3)
        self.assertGreater(max(haematocrits), 0.45)
        self.assertAlmostEqual(float(rows["venule"]["haematocrit"]), 0.4, delta=1e-9)
        result = self.run_well(os.path.join(SOURCE, "inputs/own_network.toml"), "-o", "short", "--set", "insitu.enabled=false",
                               "--set", "blood.phase_iterations=3")
        self.assertIn("not converged", result.stderr)
        self.assertNotIn("fixed point", result.stdout)

    def test_trees_of_one_generation_on_several_ranks(self):
        self.write("n.toml", tree("generations", "generations = 1").replace('query = ["artery.", "vein.0110", "4095"]', "")
                   .replace("[network]", '[network]\ntier = "distributed"'))
        flows = []
        for ranks in (1, 2, 3):
            self.run_well("n.toml", "-o", "out", ranks=ranks)
            flows.append(self.record("out")["results"]["network"]["inflow_m3_s"])
        self.assertEqual(flows, [flows[0]] * 3)

    def test_histograms_say_what_they_hold(self):
        self.write("n.toml", tree("outlet_pressure", 'outlet_pressure = "-20 mmHg"'))
        result = self.run_well("n.toml", "-o", "out")
        self.assertIn("real ones would collapse", result.stderr)
        with open(self.path / "out/histograms.csv", encoding="utf-8") as file:
            edges = [row["from"] for row in csv.DictReader(file) if (row["kind"], row["quantity"]) == ("vein", "hoop_stress_Pa")]
        self.assertIn("-inf", edges)

    def test_interrupt_is_recorded(self):
        self.write("n.toml", tree("generations", "generations = 33"))
        with subprocess.Popen([RHEXIS, "run", "n.toml", "-o", "out"], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            seen = ""
            while "network" not in seen:  # the header's
                seen = process.stdout.readline()
            time.sleep(0.5)
            process.send_signal(signal.SIGINT)
            _, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, error)
        record = self.record("out")
        self.assertEqual((record["status"], record["input"]["tree"]["generations"]["value"]), ("failed: interrupted by SIGINT", 33))

    def test_solver_that_does_not_reach_its_aim_is_status_3(self):
        result = self.rhexis("run", os.path.join(SOURCE, "inputs/circle_of_willis.toml"), "-o", "out", "--set", "insitu.enabled=false",
                             "--set", "network.solver=jacobi", "--set", "network.max_iterations=1")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertTrue(self.record("out")["status"].startswith("failed: "))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
