# SPDX-License-Identifier: BSD-3-Clause
"""Inputs of networks that are wrong, and what `check` says of those that are right.

Run by ctest as: test_network_inputs.py RHEXIS SOURCE_DIR MPIRUN...
"""

import os
import subprocess
import sys
import unittest

from network_case import RHEXIS, TREE, NetworkCase, tree

# name, input, what the message must contain
WRONG = [
    ("section of the other model", TREE + "[vessel]\nlength = \"2 mm\"\n", ["[vessel]", "scene.model", "vessel", "network"]),
    ("network section in a vessel scene", TREE.replace('model = "network"', ""), ["[tree]", "scene.model"]),
    ("model", tree("model", 'model = "tree"'), ["scene.model", "vessel", "network"]),
    ("no generations", tree("generations", ""), ["tree.generations", "1 to 40"]),
    ("too many generations", tree("generations", "generations = 41"), ["tree.generations", "40"]),
    ("radius without unit", tree("root_radius", "root_radius = 2"), ["tree.root_radius", "unit"]),
    ("terminal radius above the root's", tree("asymmetry", 'terminal_radius = "3 mm"'), ["tree.terminal_radius", "below"]),
    ("both exponent and terminal radius", tree("asymmetry", 'terminal_radius = "3 um"\nradius_exponent = 3'), ["both"]),
    ("asymmetries swapped", tree("least_asymmetry", "least_asymmetry = 0.95"), ["tree.least_asymmetry", "asymmetry"]),
    ("lengths of too few generations", tree("length_spread", "length_ratio_by_generation = [10, 20]"), ["length_ratio_by_generation", "12"]),
    ("curve of one point", tree("length_spread", 'length_by_radius = [["1 mm", "2 mm"]]'), ["length_by_radius", "two"]),
    ("curve that falls back", tree("length_spread", 'length_by_radius = [["2 mm", "2 mm"], ["1 mm", "2 mm"]]'), ["length_by_radius", "increase"]),
    ("one condition", tree("outlet_pressure", ""), ["flow.inlet_pressure", "two"]),
    ("three conditions", tree("outlet_pressure", 'outlet_pressure = "5 mmHg"\ninlet_flow = "1 L/min"'), ["two"]),
    ("absent vessel", tree("query", 'query = ["artery.0120"]'), ["network.query", "0120", "0 and 1"]),
    ("vessel beyond the last", tree("query", 'query = ["8190"]'), ["network.query", "8189"]),
    ("path too long", tree("query", 'query = ["vein.000000000000"]'), ["network.query", "11 steps"]),
    ("acceleration of two components", tree("outlet_pressure", 'outlet_pressure = "5 mmHg"\nacceleration = ["1 m/s2", "0 m/s2"]'), ["flow.acceleration", "three"]),
    ("phase separation without a graph", TREE + "[blood]\nphase_separation = true\n", ["blood.phase_separation", "explicit"]),
    ("one file of two", TREE.replace("[network]", '[network]\nsource = "file"\nfiles = ["j.csv"]'), ["network.files", "j.csv", "two .csv"]),
    ("files of a tree", TREE.replace("[network]", '[network]\nfiles = ["j.csv"]'), ["network.files", "source"]),
    ("haematocrit of one", TREE + "[blood]\nhaematocrit = 1\n", ["blood.haematocrit"]),
    ("huge explicit tree", tree("generations", "generations = 34").replace("[network]", '[network]\ntier = "explicit"'), ["network.tier", "implicit"]),
    ("huge distributed tree", tree("generations", "generations = 40").replace("[network]", '[network]\ntier = "distributed"'), ["network.tier", "GB"]),
    ("daughters of nothing", tree("least_asymmetry", "least_asymmetry = 1e-4\nradius_exponent = 6"), ["tree.least_asymmetry", "narrower daughter"]),
    ("vessels thinner than molecules", tree("asymmetry", "asymmetry = 1e-3\nradius_exponent = 2").replace("least_asymmetry = 0.4\n", ""), ["tree.asymmetry", "narrowest", "m"]),
    ("absent script", TREE + '[insitu]\nscripts = ["nowhere.py"]\n', ["insitu.scripts", "nowhere.py"]),
]


class NetworkInputs(NetworkCase):
    def test_wrong_inputs(self):
        for name, text, fragments in WRONG:
            with self.subTest(name):
                self.write("n.toml", text)
                self.assert_refused(self.rhexis("run", "n.toml"), ["n.toml", *fragments], name, ["n.toml"])
        self.write("n.toml", WRONG[-8][1])
        self.assert_refused(self.rhexis("run", "n.toml", ranks=3), WRONG[-8][2], "three ranks", ["n.toml"])

    def test_check(self):
        self.write("n.toml", TREE)
        result = self.rhexis("check", "n.toml")
        self.assertEqual(result.returncode, 0, result.stderr)
        for text in ("8,190", "2 mm", "memory", "time"):
            self.assertIn(text, result.stdout)
        self.assertEqual(os.listdir(self.path), ["n.toml"])
        result = self.rhexis("check", "n.toml", "--set", "network.tier=distributed", "--set", "tree.generations=40")
        self.assert_refused(result, ["network.tier", "GB", "implicit"], "check of a tree that fits no machine", ["n.toml"])

    def test_vtp_files_without_paraview_are_refused_at_once(self):
        self.write("n.toml", TREE)
        for command in ("check", "run"):
            result = subprocess.run([RHEXIS, command, "n.toml", "--set", "network.vtp=true"], cwd=self.path, capture_output=True, text=True,
                                    env={**os.environ, "RHEXIS_PLUGIN_DIR": "/none"}, timeout=60, check=False)
            self.assert_refused(result, ["network.vtp=true", "ParaView"], command, ["n.toml"])

    def test_restart_is_for_vessels(self):
        self.write("n.toml", TREE)
        self.assert_refused(self.rhexis("run", "n.toml", "--restart", "x.h5"), ["--restart"], "restart", ["n.toml"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
