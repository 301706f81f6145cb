# SPDX-License-Identifier: BSD-3-Clause
"""Networks from the user's files: what is refused, told, left out and added, and the page about a network.

Run by ctest as: test_network_files.py RHEXIS SOURCE_DIR MPIRUN...
"""

import os
import sys
import unittest
import unittest.mock

from network_case import FILES, HAS_PARAVIEW, JUNCTIONS, SOURCE, VESSELS, NetworkCase

# name, junctions, vessels, message
WRONG_FILES = [
    ("floating component", JUNCTIONS + "d,9,9,9,\ne,9,9,8,\n", VESSELS + "3,d,e,50\n", ["junction d", "pressure"]),
    ("negative radius", JUNCTIONS, VESSELS.replace(",50", ",-50"), ["v.csv:2", "radius"]),
    ("zero length", JUNCTIONS.replace("3,4,0", "0,0,0"), VESSELS, ["v.csv:2", "length"]),
    ("nan", JUNCTIONS, VESSELS.replace(",50", ",nan"), ["v.csv:2", "nan"]),
    ("self loop", JUNCTIONS, VESSELS.replace("1,a,b", "1,a,a"), ["v.csv:2", "itself"]),
    ("duplicate", JUNCTIONS, VESSELS.replace("2,b", "1,b"), ["v.csv:3", "already"]),
    ("unknown junction", JUNCTIONS, VESSELS.replace("1,a", "1,q"), ["v.csv:2", "from = q"]),
    ("cut short", JUNCTIONS, VESSELS[:-6], ["v.csv:3", "cut short"]),
    ("unit missing", JUNCTIONS, VESSELS.replace(" [um]", ""), ["v.csv:1", "radius", "unit"]),
    ("wrong dimension", JUNCTIONS, VESSELS.replace("[um]", "[mmHg]"), ["v.csv:1", "radius"]),
]


class NetworkFiles(NetworkCase):
    def test_wrong_files(self):
        self.write("n.toml", FILES)
        files = ["n.toml", "j.csv", "v.csv"]
        for name, junctions, vessels, fragments in WRONG_FILES:
            self.write("j.csv", junctions)
            self.write("v.csv", vessels)
            for more, ranks in (([], None), ([], 2), (["--set", "network.tier=distributed"], 2)):
                with self.subTest(name, ranks=ranks, more=more):
                    self.assert_refused(self.rhexis("run", "n.toml", *more, ranks=ranks), fragments, name, files)
        self.write("v.csv", VESSELS)
        for tier in ("explicit", "distributed"):
            result = self.rhexis("run", "n.toml", "--set", "network.query=['9']", "--set", f"network.tier={tier}", ranks=2)
            self.assert_refused(result, ["no vessel '9'"], f"query, {tier}", files)
        for key, value in (("flow.inlet_pressure", "100 mmHg"), ("tree.generations", "4")):
            result = self.rhexis("run", "n.toml", "--set", f"{key}={value}")
            self.assert_refused(result, [key, value, "the files say it"], key, files)
        # More loops than series and parallel vessels make.
        self.write("v.csv", VESSELS + "3,a,c,9\n4,d,b,9\n5,d,c,9\n6,b,e,9\n7,e,c,9\n8,e,f,9\n9,f,b,9\n10,f,c,9\n")
        self.write("j.csv", JUNCTIONS + "d,1,1,1,20\ne,2,2,2,\nf,3,2,2,\n")
        result = self.rhexis("run", "n.toml", "--set", "network.solver=elimination")
        self.assert_refused(result, ["'elimination' leaves", "'auto'"], "elimination", files)
        self.write("v.csv", VESSELS)
        os.remove(self.path / "j.csv")
        self.assert_refused(self.rhexis("run", "n.toml"), ["network.files", "j.csv"], "absent file", ["n.toml", "v.csv"])

    def test_conditions_of_the_input_and_what_is_left_out(self):
        self.write("j.csv", JUNCTIONS + "d,9,9,9,\ne,9,9,8,\n")
        self.write("v.csv", VESSELS + "3,d,e,50\n4,b,b,50\n")
        self.write("n.toml", FILES + 'drop = ["self_loops", "islands"]\n'
                   '[[condition]]\njunction = "a"\npressure = "20 mmHg"\n'
                   '[[condition]]\nnearest = ["3 mm", "4 mm", "13 mm"]\nflow = "-1e-3 mL/min"\n')
        result = self.run_well("n.toml", "-o", "out")
        network = self.record("out")["results"]["network"]
        self.assertEqual((network["vessels"], network["junctions"]), (2, 3))
        self.assertAlmostEqual(network["inflow_m3_s"] / (1e-9 / 60), 1, delta=1e-12)
        self.assertAlmostEqual(network["highest_pressure_Pa"], 20 * 133.322387415, delta=1e-6)
        self.assertIn("condition[2] is at junction c", result.stdout)
        for more, fragments in (
                (["condition[1].junction=q"], ["condition[1].junction=q", "no junction of this id or name"]),
                (["condition[2].haematocrit=45"], ["condition[2].haematocrit", "at most 0.95"]),
                (["network.drop=['loops']"], ["network.drop", "self_loops"])):
            result = self.rhexis("run", "n.toml", "--set", *more)
            self.assert_refused(result, fragments, more[0], ["n.toml", "j.csv", "v.csv", "out"])

    def test_flows_that_mean_little_are_told(self):
        self.write("n.toml", FILES)
        self.write("v.csv", VESSELS)
        self.write("j.csv", JUNCTIONS)
        self.assertIn("2 vessels, 3 junctions", self.rhexis("check", "n.toml").stdout)
        for junctions, vessels, warning in (
                (JUNCTIONS.replace("12,0", "12,"), VESSELS, "nothing flows: no difference"),
                (JUNCTIONS, VESSELS.replace("50", "2").replace("40", "2").replace("[um]", "[mm]"), "the Reynolds number reaches"),
                (JUNCTIONS, VESSELS.replace("[um]", "[mm]"), "an inflow of"),
                (JUNCTIONS, VESSELS.replace("[um]", "[mm]"), str(self.path / "v.csv") + ":2: vessel 1, the first of 2: radius 50 mm"),
                (JUNCTIONS.replace("12,0", "12,-20"), VESSELS, "the pressure falls to -20 mmHg"),
                (JUNCTIONS.replace("12,0", "12,-1000"), VESSELS, "the pressure falls to -1000 mmHg, below vacuum"),
                (JUNCTIONS, VESSELS, None)):
            self.write("j.csv", junctions)
            self.write("v.csv", vessels)
            for more, ranks in (([], None), (["--set", "network.tier=distributed"], 2)):
                result = self.run_well("n.toml", "-o", "out", *more, ranks=ranks)
                record = self.record("out")
                told = [w for w in record["warnings"] if warning and w.startswith(warning)]
                self.assertEqual(len(told), 1 if warning else 0, record["warnings"])
                self.assertTrue(warning or not record["warnings"], record["warnings"])
                self.assertEqual(result.stderr.count("rhexis: warning: "), len(record["warnings"]), result.stderr)
                if warning and "Reynolds" in warning:
                    self.assertGreater(record["results"]["network"]["highest_reynolds"], 2300)

    def test_junctions_without_vessels_count(self):
        self.write("n.toml", FILES)
        self.write("v.csv", VESSELS)
        self.write("j.csv", JUNCTIONS + "d,9,9,9,\n")
        for tier, ranks in (("explicit", None), ("distributed", 2)):
            self.run_well("n.toml", "-o", "out", "--set", f"network.tier={tier}", ranks=ranks)
            self.assertEqual(self.record("out")["results"]["network"]["junctions"], 4)

    def test_networks_without_places_are_not_drawn(self):
        self.write("n.toml", FILES)
        self.write("v.csv", "id,from,to,radius [um],length [mm]\n1,a,b,50,5\n2,b,c,40,12\n")
        self.write("j.csv", "id,pressure [mmHg]\na,10\nb,\nc,0\n")
        for more, ranks in (([], None), (["--set", "network.tier=distributed"], 2)):
            result = self.run_well("n.toml", "-o", "out", "--set", f"insitu.scripts=['{SOURCE}/catalyst_scripts/network.py']", *more, ranks=ranks)
            self.assertIn("no coordinates", result.stderr)
            self.assertEqual(self.record("out")["status"], "completed")

    def test_a_page_about_a_network(self):
        self.write("n.toml", FILES)
        self.write("j.csv", JUNCTIONS + "d,0,0,1,\n")
        self.write("v.csv", VESSELS.replace("2,b,c,40", "2,b,c,40\n3,b,d,30"))
        pages = [self.rhexis("network", *files) for files in (("j.csv", "v.csv"), ("n.toml",))]
        for page in pages:
            self.assertEqual(page.returncode, 0, page.stderr)
            for part in ("vessels     3", "junctions   4", "3 ends, 2 conditions", "no flow     in 1 of 3 vessels", "radii of the vessels", "####", "can be solved"):
                self.assertIn(part, page.stdout)
            self.assertIn("no condition, so that nothing flows there: d", page.stderr)
        # What is written can be read again, gives the same flow, and is not written over another file.
        self.assertEqual(self.rhexis("network", "j.csv", "v.csv", "-o", "clean.json").returncode, 0)
        self.run_well("n.toml", "-o", "first")
        self.run_well("n.toml", "--set", "network.files=['clean.json']", "-o", "again")
        first, again = ((self.path / folder / "vessels.csv").read_text() for folder in ("first", "again"))
        self.assertEqual(first, again)
        for arguments, message in ((("j.csv", "v.csv", "-o", "clean.json"), "--overwrite"), (("clean.json", "-o", "clean.json", "--overwrite"), "is read from this file"),
                                   (("j.csv", "v.csv", "-o", "clean.txt"), ".json or .vtp"), (("j.csv",), "two .csv files"), (("gone.json",), "gone.json"),
                                   (("x.vtp",), "--length-unit mm")):
            result = self.rhexis("network", *arguments)
            self.assertEqual(result.returncode, 2, message)
            self.assertIn(message, result.stderr)
        self.assertEqual(self.rhexis("network", "j.csv", "v.csv", "-o", "clean.json", "--overwrite").returncode, 0)

    @unittest.skipUnless(HAS_PARAVIEW, "built without ParaView")
    def test_a_picture_of_a_network(self):
        import numpy
        from matplotlib import image

        self.write("j.csv", JUNCTIONS + "d,0,9,9,\n")
        self.write("v.csv", VESSELS.replace("1,a,b,50", "1,a,b,900") + "3,b,d,100\n")
        for name, ranks in (("one.png", None), ("two.png", 2)):
            result = self.rhexis("network", "j.csv", "v.csv", "--picture", name, ranks=ranks)
            self.assertEqual(result.returncode, 0, result.stderr)
        one, two = ((self.path / name).read_bytes() for name in ("one.png", "two.png"))
        self.assertTrue(one == two, "the picture is another one on two ranks")
        picture = numpy.rint(255 * image.imread(self.path / "one.png")[..., :3]).astype(int)
        self.assertEqual(picture.shape, (720, 1280, 3))

        def pixels(colour):
            return (numpy.abs(picture[100:600] - colour) <= 3).all(axis=-1).sum()

        # Above the legends: the end without a condition and the two with one, as marks of 9 x 9 pixels.
        self.assertGreater(pixels((230, 76, 0)), 60)
        self.assertLess(pixels((230, 76, 0)), 100)
        # The widest vessel has the dark end of the scale, the thinnest its yellow one.
        violet = (picture[100:600, :, 2] > picture[100:600, :, 1] + 30).sum()
        yellow = (picture[100:600, :, 1] > picture[100:600, :, 2] + 60).sum()
        self.assertGreater(violet, 5000)
        self.assertGreater(yellow, 100)
        self.assertLess(yellow, violet)
        self.assertEqual(sorted(os.listdir(self.path)), ["j.csv", "one.png", "two.png", "v.csv"])

    def test_pictures_that_cannot_be_are_refused(self):
        self.write("j.csv", JUNCTIONS)
        self.write("v.csv", VESSELS)
        self.write("k.csv", "id,pressure [mmHg]\na,10\nb,\nc,0\n")
        self.write("w.csv", "id,from,to,radius [um],length [mm]\n1,a,b,50,5\n2,b,c,40,12\n")
        files = ["j.csv", "v.csv", "k.csv", "w.csv"]
        mistakes = [("p.jpg", "must end in .png"), ("nowhere/p.png", "there is no folder")]
        for name, message in mistakes:
            self.assert_refused(self.rhexis("network", "j.csv", "v.csv", "--picture", name), [name, message], name, files)
        with unittest.mock.patch.dict(os.environ, {"RHEXIS_PLUGIN_DIR": "/none"}):
            result = self.rhexis("network", "j.csv", "v.csv", "--picture", "p.png", ranks=2)
        self.assert_refused(result, ["--picture: there can be no picture"], "no plugin", files)
        if HAS_PARAVIEW:
            result = self.rhexis("network", "k.csv", "w.csv", "--picture", "p.png")
            self.assert_refused(result, ["--picture: the junctions have no coordinates"], "no coordinates", files)
        self.write("p.png", "")
        result = self.rhexis("network", "j.csv", "v.csv", "--picture", "p.png")
        self.assert_refused(result, ["p.png: there is such a file", "--overwrite"], "in the way", [*files, "p.png"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
