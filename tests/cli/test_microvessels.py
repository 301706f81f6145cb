# SPDX-License-Identifier: BSD-3-Clause
"""Networks of microvessels in the .dat format of Secomb's programs, of the size and with the conditions of those that are measured.

Run by ctest as: test_microvessels.py RHEXIS SOURCE_DIR MPIRUN...
"""

import csv
import math
import random
import sys
import unittest
from collections import Counter

from independent_flow import MMHG, NL_PER_MIN, UM, solve
from network_case import NetworkCase

SCENE = """\
[scene]
model = "network"
[insitu]
enabled = false
[network]
source = "file"
files = ["network.dat"]
"""
RAT = """\
[blood]
viscosity_law = "in_vivo"
mean_cell_volume = "55 fL"
phase_separation = true
"""
PLASMA, MEAN_CELL_VOLUME = 1.0466e-3, 55  # Pa s, fL


def meshwork(rows, columns, ends, radius, spacing, seed):
    """Vessels that meet in threes, as bricks do in a wall, with ends at its rim: segments (name, from, to, diameter in um) and the places of
    nodes in um."""
    dice = random.Random(seed)
    node = {(i, j): 100 + i * columns + j for i in range(rows) for j in range(columns)}
    joints = [((i, j), (i, j + 1)) for i in range(rows) for j in range(columns - 1)]
    joints += [((i, j), (i + 1, j)) for i in range(rows - 1) for j in range(columns) if (i + j) % 2 == 0]
    degree = Counter(end for joint in joints for end in joint)
    place = {node[i, j]: [spacing * (c + dice.uniform(-0.3, 0.3)) for c in (j, i, 0)] for i, j in node}
    pairs = [(node[a], node[b]) for a, b in joints]
    rim = [p for p in sorted(node) if degree[p] == 2]
    for k in range(ends):
        i, j = rim[k * len(rim) // ends]
        outside = 1 + k
        place[outside] = [spacing * c for c in (j + (j > columns / 2) - 0.5, i + (i > rows / 2) - 0.5, 0.4)]
        pairs.append((node[i, j], outside) if k % 2 else (outside, node[i, j]))
    return [(n + 1, a, b, 2 * radius(dice)) for n, (a, b) in enumerate(pairs)], place


def dat_file(segments, place, conditions, head="a network", count="total number of boundary nodes", flourish=""):
    """The text of a .dat file; conditions: node, type, value, haematocrit."""
    rows = [head, "2600. 1400. 20. box dimensions in microns", "92 142 1 number of tissue points in x,y,z directions",
            "100.\touter bound distance", "150.\tmax. segment length", "4\t\tmaximum number of segments per node",
            f"{len(segments)}\ttotal number of segments", "SegName Type StartNode EndNode Diam   Flow[nl/min]    Hd"]  # fmt: skip
    rows += [f"{name} {4 + name % 2} {a} {b} {diameter!r} 0.000000 0.000000{flourish}" for name, a, b, diameter in segments]
    rows += [f"{len(place)}\ttotal number of nodes", "Name\tx\ty\tz"]
    rows += ["\t".join([str(n), *map(repr, x)]) + flourish for n, x in place.items()]
    rows += [f" {len(conditions)} {count}", "Node\t Bctype\t Press/Flow\t HD\t PO2"]
    rows += [f"{n} {kind} {value!r} {haematocrit!r} 40.000000{flourish}" for n, kind, value, haematocrit in conditions]
    return "\n".join(rows)  # without an end of line at the end


def in_vivo_viscosity(radius, haematocrit):
    """Pries et al. 1994, for red cells of MEAN_CELL_VOLUME; Pa s."""
    d = 2e6 * radius * (92 / MEAN_CELL_VOLUME) ** (1 / 3)
    t = 1 / (1 + 1e-11 * d**12)
    c = (0.8 + math.exp(-0.075 * d)) * (t - 1) + t
    f = ((1 - haematocrit) ** c - 1) / ((1 - 0.45) ** c - 1)
    n45 = 6 * math.exp(-0.085 * d) + 3.2 - 2.44 * math.exp(-0.06 * d**0.645)
    w = (d / (d - 1.1)) ** 2
    return PLASMA * (1 + (n45 - 1) * f * w) * w


def share_of_cells(share, haematocrit, parent, a, b):
    """Pries & Secomb 2008: the share of the red cells that branch a gets with its share of the flow; diameters in um."""
    h = (1 - haematocrit) / parent
    y = (share - 0.964 * h) / (1 - 2 * 0.964 * h)
    if not 0 < y < 1:
        return 0 if y <= 0 else 1
    q = (a / b) ** 2
    return 1 / (1 + math.exp(13.29 * h * (q - 1) / (q + 1) - (1 + 6.98 * h) * math.log(y / (1 - y))))


class Microvessels(NetworkCase):
    def run_dat(self, text, keys, *more):
        self.write("n.toml", SCENE + keys)
        self.write("network.dat", text)
        result = self.run_well("n.toml", "-o", "out", *more)
        with open(self.path / "out/vessels.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file)), self.record("out")["results"]["network"], result.stdout + result.stderr

    def test_a_mesentery_with_phase_separation(self):
        """As measured in rats: 546 vessels, the flows and haematocrits of all inlets known, a pressure at the main outlet."""
        segments, place = meshwork(14, 26, 27, lambda dice: min(max(dice.lognormvariate(math.log(6), 0.35), 2.5), 14), 100, 1)
        self.assertEqual(len(segments), 546)
        dice = random.Random(2)
        ends = range(1, 28)
        conditions = [(n, 2, dice.uniform(0.5, 8) * (-0.2 if n % 6 == 0 else 1), dice.uniform(0.1, 0.55)) for n in ends[:-1]]
        conditions.append((27, 0, 13.8, 0.55))
        text = dat_file(segments, place, conditions, "\ufeffNetwork of 28-10-90 with 546 segments", "Total number of boundary nodes", " *")
        rows, network, told = self.run_dat(text, RAT)
        self.assertIn("haematocrit fixed point after", told)
        self.assertNotIn("not converged", told)
        self.assertEqual((network["vessels"], network["junctions"]), (546, len(place)))

        flow = {int(row["vessel"]): float(row["flow_m3_s"]) for row in rows}
        haematocrit = {int(row["vessel"]): float(row["haematocrit"]) for row in rows}
        radius = {name: UM * diameter / 2 for name, _, _, diameter in segments}
        vessels = [(a, b, UM * diameter / 2, UM * math.dist(place[a], place[b])) for _, a, b, diameter in segments]
        expected = solve(vessels, {27: 13.8 * MMHG}, {n: q * NL_PER_MIN for n, kind, q, _ in conditions if kind == 2},
                         [in_vivo_viscosity(radius[s[0]], haematocrit[s[0]]) for s in segments])  # fmt: skip
        inflow = network["inflow_m3_s"]
        for (name, *_), q in zip(segments, expected):
            self.assertLess(abs(flow[name] - q), 1e-7 * inflow, name)

        entering = {n: h for n, kind, q, h in conditions if kind == 2 and q > 0}
        bifurcations = 0
        for n in place:
            signed = [(name, flow[name] * (1 if b == n else -1)) for name, a, b, _ in segments if n in (a, b)]
            come = [(name, q) for name, q in signed if q > 0]
            leave = [(name, -q) for name, q in signed if q < 0]
            if n in entering:
                self.assertAlmostEqual(haematocrit[leave[0][0]], entering[n], delta=1e-12)
            elif come and leave:
                cells = sum(haematocrit[name] * q for name, q in come)
                self.assertLess(abs(cells - sum(haematocrit[name] * q for name, q in leave)), 1e-9 * inflow, n)
                if len(leave) == 2 and len(come) == 1 and leave[0][1] > 1e-6 * inflow < leave[1][1]:
                    (parent, whole), (a, qa), (b, _) = come[0], *leave
                    share = share_of_cells(qa / whole, haematocrit[parent], *(2e6 * radius[v] for v in (parent, a, b)))
                    # Where so many cells take one branch that it is full, the rest takes the other.
                    if haematocrit[a] < 0.98 and haematocrit[b] < 0.98:
                        self.assertAlmostEqual(haematocrit[a] * qa / (haematocrit[parent] * whole), share, delta=1e-6, msg=n)
                        bifurcations += 1
        self.assertGreater(bifurcations, 100)

    def test_a_cortex_with_flows_at_all_ends(self):
        """As estimated in mice: 4,881 segments, whole micrometres, flows with a class code at all ends, no pressure anywhere."""
        segments, place = meshwork(50, 66, 14, lambda dice: round(max(dice.lognormvariate(math.log(2.6), 0.3), 2), 3), 60, 3)
        self.assertEqual(len(segments), 4881)
        place = {n: [round(c) for c in x] for n, x in place.items()}
        flows = [60, 45.5, 7.25, 22, -30, 18.125, -50, -12, 3.5, -8, -20, -16.5, 31, -50.875]
        self.assertEqual(sum(flows), 0)
        conditions = [(n + 1, 4 + n % 6, q, 0.4) for n, q in enumerate(flows)]
        text = dat_file(segments, place, conditions, "Brain network", "total number of known boundary nodes", " *** added node")
        keys = '[blood]\nviscosity_law = "constant"\n'
        self.write("n.toml", SCENE + keys)
        self.write("network.dat", text)
        self.assert_refused(self.rhexis("run", "n.toml"), ["nothing sets the pressure", "network.reference_pressure"], "no pressure", ["n.toml", "network.dat"])
        rows, network, told = self.run_dat(text, keys, "--set", "network.reference_pressure=20 mmHg")
        self.assertEqual(network["vessels"], 4881)
        self.assertIn("junction 14 has network.reference_pressure, 20 mmHg\n", told)
        vessels = [(a, b, UM * diameter / 2, UM * math.dist(place[a], place[b])) for _, a, b, diameter in segments]
        expected = solve(vessels, {14: 20 * MMHG}, {n: q * NL_PER_MIN for n, _, q, _ in conditions[:-1]})
        inflow = network["inflow_m3_s"]
        self.assertAlmostEqual(inflow / (sum(q for q in flows if q > 0) * NL_PER_MIN), 1, delta=1e-12)
        for row, q in zip(rows, expected):
            self.assertLess(abs(float(row["flow_m3_s"]) - q), 1e-8 * inflow, row["vessel"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
