# SPDX-License-Identifier: BSD-3-Clause
"""The benchmark script: its table from recorded cases, what it says where the programs are not built, and, where they are,
a quick run.

Run by ctest as: test_benchmarks.py BUILD_DIR SOURCE_DIR
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

BUILD, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SCRIPT = SOURCE / "postprocessing/benchmarks.py"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPT.parent))

import benchmarks

THEIRS = {"family_index": 7, "per_family_instance_index": 0, "repetitions": 1, "repetition_index": 0, "threads": 1, "iterations": 15,
          "run_type": "iteration", "real_time": 4.5, "cpu_time": 6.1, "time_unit": "ms"}
BONDS = {**THEIRS, "name": "bonds/section=lattice/across=5/rows=104/bonds=single/law=pmb/wall=scattered/damage=cracked75/threads=2"
                           "/iterations:15/manual_time",
         "bonds_per_s": 1.2345e9, "flop_per_s": 43.21e9, "ns_per_particle_step": 80.06, "of_peak": 0.2468, "of_arithmetic": 0.0456}
TREE = {**THEIRS, "name": "network/tier=implicit/generations=26/way=up/threads=1/iterations:5/manual_time",
        "vessels": 134217726, "vessels_per_s": 4.08e8, "ns_per_vessel": 2.451, "of_peak": 0.067}
FRAME = {**THEIRS, "name": "output/frame=particles/rows=100/iterations:15/manual_time",
         "particles": 54800, "bytes": 3068800, "bytes_per_s": 1.71e8, "ms_per_frame": 17.95, "of_peak": 0.449}
SERIES = {**THEIRS, "name": "series/format=xdmf/outputs=10000/iterations:10000/manual_time",
          "ms_to_lay_out": 4941.0, "ms_at_10": 0.4221, "ms_at_1000": 0.3114, "ms_at_10000": 0.3281}
MACHINE = {**THEIRS, "name": "machine/load=L1/threads=2/iterations:15/manual_time", "rate": 6.33e11, "best": 6.57e11}


def results(*cases):
    machine = {"cpu": "A processor", "cores": "2", "program": "0.1.0 (abc)", "built": "Release, GNU", "caches_bytes": {"L1 data": 49152},
               "memory_bytes": 2**34}
    return {"machine": machine, "time": "2026-01-01", "load": [0.1, 1.2], "cases": [benchmarks.case_of(case) for case in cases]}


class Table(unittest.TestCase):
    def test_case_has_its_name_and_its_counters(self):
        case = benchmarks.case_of(BONDS)
        self.assertEqual({key: case[key] for key in ("what", "rows", "damage", "threads", "samples")},
                         {"what": "bonds", "rows": "104", "damage": "cracked75", "threads": "2", "samples": 15})
        self.assertEqual(case["of_peak"], 0.2468)
        self.assertNotIn("real_time", case)

    def test_report(self):
        lines = benchmarks.report(results(BONDS, TREE, FRAME, SERIES, MACHINE)).splitlines()
        self.assertIn("load 0.1 before and 1.2 after", lines[0])
        self.assertIn("L1 data 48 KiB, 16 GiB", lines[0])
        for row in ("| lattice 5, 104 rows, scattered | single | pmb | cracked 75 % | 2 | 1.23 | 43.2 | 80.1 | 25 % | 4.6 % |",
                    "| implicit | 26 generations, up | 134,217,726 | 1 | 408 | 2.45 | 6.7 % |",
                    "| particles | 54,800 | 3.07 | 17.9 | 171 | 45 % |",
                    "| xdmf | 10000 | 4.94 | 0.422 | 0.311 | 0.328 |",
                    "| loads from L1 | 2 | 633 | 657 | GB/s |"):
            self.assertIn(row, lines)

    def test_what_was_not_counted_has_no_share(self):
        uncounted = {key: value for key, value in BONDS.items() if key != "of_arithmetic"}
        self.assertIn("| 25 % | - |", benchmarks.report(results(uncounted)))


class Script(unittest.TestCase):
    def test_says_what_to_build(self):
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder) / "out"
            done = subprocess.run([SCRIPT, "--build", folder, "-o", output], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(len(done.stderr.splitlines()), 1)
            for words in ("bench_bonds", "apt-get install libbenchmark-dev", "-DRHEXIS_BENCHMARKS=ON"):
                self.assertIn(words, done.stderr)
            self.assertFalse(output.exists())

    @unittest.skipUnless(all((BUILD / "bin" / name).exists() for name in benchmarks.PROGRAMS), "benchmarks are not built")
    def test_quick_run(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([SCRIPT, "--quick", "--build", BUILD, "-o", folder], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            found = json.loads((pathlib.Path(folder) / "benchmarks.json").read_text(encoding="utf-8"))
            self.assertEqual((pathlib.Path(folder) / "benchmarks.md").read_text(encoding="utf-8"), benchmarks.report(found))
        cases = found["cases"]
        self.assertLessEqual({"machine", "bonds", "network", "output"}, {case["what"] for case in cases})
        for case in cases:
            if case["what"] in ("bonds", "network"):
                self.assertTrue(0 < case["of_peak"] < 1, case)
        walls = {case["damage"]: case for case in cases
                 if case["what"] == "bonds" and all(case[key] == value for key, value in (
                     ("section", "lattice"), ("rows", "104"), ("bonds", "single"), ("law", "pmb"), ("wall", "uniform"), ("threads", "1")))}
        whole = walls["none"]["bonds_a_particle"]
        self.assertTrue(129 < whole < 131, whole)  # 131.05 in an endless wall, fewer near the ends
        for damage, intact in (("scattered25", 0.75), ("scattered75", 0.25), ("cracked25", 0.75), ("cracked75", 0.25)):
            self.assertAlmostEqual(walls[damage]["bonds_a_particle"] / whole, intact, delta=0.02, msg=damage)
        for case in walls.values():
            self.assertAlmostEqual(case["flop_per_s"] / case["bonds_per_s"], 21.5)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
