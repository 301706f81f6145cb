#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Speed against error of the network tiers, as tables and a plot.

    cmake --preset release -DRHEXIS_BENCHMARKS=ON && cmake --build --preset release
    postprocessing/network_speed_and_error.py [--generations 16 20 24] [--junctions 200000] [--skip-slow] [-o FOLDER]

1. Tier 1 (recursion) against long double: every vessel of random tree pairs (build/release/bin/tree_flow).
2. The same random tree by all tiers through `rhexis run`: time, memory, and the largest difference from tier 1 over
   200 vessels of all generations, in flow (of the flow itself) and pressure (of the pressure difference).
3. Solvers of a graph with loops and conductances of contrast 1e12, each to several imbalances
   (build/release/bin/network_solvers; slow: plain conjugate gradients and the complete factor take minutes).
"""

import argparse
import json
import pathlib
import random
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BIN = ROOT / "build/release/bin"
SCENE = """
[scene]
model = "network"
[tree]
generations = {generations}
root_radius = "12.5 mm"
terminal_radius = "{terminal} um"
asymmetry = 1
least_asymmetry = 0.7
length_spread = 0.2
[flow]
inlet_pressure = "95 mmHg"
outlet_pressure = "3 mmHg"
[network]
statistics = false
shown_vessels = 2
query = [{query}]
"""


def random_vessels(generations, count=200):
    """Paths of vessels, some of every generation."""
    choice = random.Random(1)
    paths = set()
    for i in range(count):
        steps = "".join(choice.choice("01") for _ in range(i % generations))
        paths.add(choice.choice(("artery.", "vein.")) + steps)
    return sorted(paths)


def run_tier(folder, generations, tier, ranks):
    query = random_vessels(generations)
    scene = folder / f"tree_{generations}.toml"
    terminal = 3 * 2 ** ((34 - generations) / 2.76)
    scene.write_text(SCENE.format(generations=generations, terminal=terminal, query=", ".join(f'"{q}"' for q in query)))
    output = folder / f"{tier}_{generations}_{ranks}"
    launcher = ["mpirun", "--oversubscribe", "--allow-run-as-root", "-n", str(ranks)] if ranks > 1 else []
    subprocess.run([*launcher, BIN / "rhexis", "run", scene, "-o", output, "--quiet", "--set", f"network.tier={tier}"], check=True)
    return json.loads((output / "run.json").read_text())


def compare(record, truth):
    drop = 92 * 133.322387415
    flow = pressure = 0.0
    for a, b in zip(record["results"]["network"]["queries"], truth["results"]["network"]["queries"], strict=True):
        flow = max(flow, abs(a["flow_m3_s"] / b["flow_m3_s"] - 1))
        for end in ("pressure_from_Pa", "pressure_to_Pa"):
            pressure = max(pressure, abs(a[end] - b[end]) / drop)
    return flow, pressure


def tiers(folder, generations):
    rows = []
    for k in generations:
        truth = run_tier(folder, k, "implicit", 1)
        for tier, ranks in (("implicit", 1), ("explicit", 1), ("distributed", 1), ("distributed", 2)):
            record = truth if tier == "implicit" else run_tier(folder, k, tier, ranks)
            flow, pressure = compare(record, truth)
            vessels = record["results"]["network"]["vessels"]
            cost = record["performance"]
            rows.append({"k": k, "tier": tier, "ranks": ranks, "vessels": vessels, "seconds": cost["wall_s"],
                         "ns_per_vessel": 1e9 * cost["wall_s"] / vessels,
                         "bytes_per_vessel": cost["peak_rss_bytes"] / vessels, "flow": flow, "pressure": pressure})
    return rows


def print_table(title, header, rows):
    print(f"\n{title}\n\n| " + " | ".join(header) + " |\n|" + " --- |" * len(header))
    for row in rows:
        print("| " + " | ".join(str(cell) for cell in row) + " |")


def plot(path, recursion, tier_rows, solvers):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2))

    def show(points, marker, label):
        """Points (generations, ns per vessel, error), each with its generations written beside it."""
        line = left.plot([time for _, time, _ in points], [max(error, 1e-16) for _, _, error in points], marker, label=label)[0]
        height = 8 + 11 * len(left.lines)  # errors are much alike: a height for each tier's labels
        for k, time, error in points:
            left.annotate(f"k = {k}", (time, max(error, 1e-16)), xytext=(0, -height), textcoords="offset points",
                          fontsize=8, ha="center", color=line.get_color())

    known = [r for r in recursion if r["flow_error"] is not None]
    show([(r["generations"], r["up_ns"] + r["down_ns"], r["flow_error"]) for r in known], "o",
         "recursion with statistics (against long double)")
    for tier, ranks, marker in (("explicit", 1, "s"), ("distributed", 1, "^"), ("distributed", 2, "v")):
        points = [r for r in tier_rows if (r["tier"], r["ranks"]) == (tier, ranks)]
        show([(r["k"], r["ns_per_vessel"], r["flow"]) for r in points], marker,
             f"{tier}, {ranks} rank{'s' if ranks > 1 else ''} (against recursion)")
    left.set(xscale="log", yscale="log", ylim=(1e-16, 1e-13), xlabel="time / ns per vessel",
             ylabel="largest relative error of a flow", title="Tree pairs of k generations by tier")
    left.legend(fontsize=8)
    for name in dict.fromkeys(r["solver"] for r in solvers):
        points = [r for r in solvers if r["solver"] == name]
        right.plot([r["seconds"] for r in points], [r["flow_error"] for r in points], "o-", label=name)
    right.set(xscale="log", yscale="log", xlabel="time / s", ylabel="largest error of a flow / inflow",
              title="Loops, contrast 1e12")
    if solvers:
        right.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--generations", type=int, nargs="+", default=[16, 20, 24])
    parser.add_argument("--junctions", type=int, default=200000)
    parser.add_argument("--skip-slow", action="store_true", help="leave the graph with loops out")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/network_speed_and_error")
    options = parser.parse_args()
    if not (BIN / "tree_flow").exists():
        sys.exit("benchmarks are not built: cmake --preset release -DRHEXIS_BENCHMARKS=ON && cmake --build --preset release")
    folder = options.output
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([BIN / "tree_flow", "--json", folder / "recursion.json"], check=True, stdout=subprocess.DEVNULL)
    recursion = json.loads((folder / "recursion.json").read_text())
    print_table("Recursion against long double, random trees", ["generations", "vessels", "up / ns", "down / ns", "flow error", "pressure error"],
                [(r["generations"], f"{r['vessels']:,}", f"{r['up_ns']:.2f}", f"{r['down_ns']:.2f}",
                  *("-" if r[e] is None else f"{r[e]:.1e}" for e in ("flow_error", "pressure_error"))) for r in recursion])
    rows = tiers(folder, options.generations)
    print_table("The same tree by tier (whole program)", ["generations", "tier", "ranks", "seconds", "ns/vessel", "bytes/vessel", "flow against tier 1", "pressure"],
                [(r["k"], r["tier"], r["ranks"], f"{r['seconds']:.2f}", f"{r['ns_per_vessel']:.1f}", f"{r['bytes_per_vessel']:.0f}",
                  f"{r['flow']:.1e}", f"{r['pressure']:.1e}") for r in rows])
    solvers = []
    if not options.skip_slow:
        subprocess.run([BIN / "network_solvers", str(options.junctions), "--json", folder / "solvers.json"], check=True)
        solvers = [row for row in json.loads((folder / "solvers.json").read_text())["methods"]]
    (folder / "tiers.json").write_text(json.dumps(rows, indent=1))
    plot(folder / "network_speed_and_error.png", recursion, rows, solvers)
    print(f"\nplot: {folder / 'network_speed_and_error.png'}")


if __name__ == "__main__":
    main()
