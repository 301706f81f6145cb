#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How a run scales with cores and with size, measured here and now: speedup, efficiency and resources, as in the paper's Fig. 2.

    postprocessing/scaling_study.py inputs/perivessel.toml --strong --layouts 1x1 1x2 2x1 --set insitu.enabled=false
    postprocessing/scaling_study.py inputs/perivessel.toml --weak 'vessel.length=10 mm' --layouts 1x1 2x1
    postprocessing/scaling_study.py inputs/whole_body.toml --sizes tree.generations=20,22,24,26 --layouts 2x1 \\
        --set 'tree.length_ratio_by_generation=[]' --set 'network.query=[]' --set insitu.enabled=false
    postprocessing/scaling_study.py INPUT --strong --layouts 48x1 96x1 192x1 --cores-per-node 48 --slurm DIR
    postprocessing/scaling_study.py --collect DIR      # when the jobs are done

A layout is RANKSxTHREADS. Strong: the input on every layout. Weak: one value of KEY for each layout, or one quantity that
is multiplied by the cores (over those of the first layout). Sizes: every value on every layout. Runs take turns, and medians
count.

Speedup S = T(c0) c0 / T(c), Eq. (11), and efficiency T(c0) / T(c), Eq. (12), of the wall-clock time of the whole
program, over cores c; c0 is the fewest. R(p) = alpha + beta p^gamma, Eq. (10), is fitted to core time, floating-point
operations and memory, where there are four sizes or more: p is the cores (strong), or the vessels of a network or the
particles of a wall.
Predictions take their rate per core from the run on the fewest cores alone, and so are tested by all others; those for
more cores than were measured are listed as predictions (formulas: performance_model.py; for walls, and trees that are not
stored). The network's latency and bandwidth are those that runs measured between their first and last rank: within a node,
and between nodes where runs used several, else as usual. Wall-clock time is that of the program, without mpirun's start.
Writes scaling.csv, scaling.json, a PNG a study.
"""

import argparse
import json
import math
import os
import pathlib
import re
import shlex
import shutil
import statistics
import sys

from performance_model import Machine, core_rate, nodes_of, problem_of, solve_seconds
from places import PROGRAM, RESULTS
from scaling_report import write_report
from scaling_runs import check_input, measured, read_machine, run_here, write_jobs



class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"error: {message}\n")


def layout(word):
    match = re.fullmatch(r"([1-9]\d*)x([1-9]\d*)", word)
    if not match:
        raise argparse.ArgumentTypeError(f"'{word}' is no layout: RANKSxTHREADS, such as 4x2")
    return int(match[1]), int(match[2])


def positive(kind):
    def parse(word):
        value = kind(word)
        if not (value > 0 and math.isfinite(value)):
            raise ValueError
        return value
    parse.__name__ = f"positive {'whole number' if kind is int else 'number'}"
    return parse


def key_and_values(word):
    key, equals, values = word.partition("=")
    if not (equals and key and all(values.split(","))):
        raise argparse.ArgumentTypeError(f"'{word}' is not KEY=VALUE[,VALUE...]")
    return key, [value.strip() for value in values.split(",")]


def multiplied(quantity, factor):
    """A number with or without a unit, times the factor."""
    match = re.fullmatch(r"([-+.\deE]*\d\.?)\s*(\D.*)?", quantity)
    if not match:
        raise ValueError(f"--weak: '{quantity}' is no number with a unit, to grow with the cores: give a value for each layout")
    number = float(match[1]) * factor
    return " ".join(filter(None, (f"{number:.15g}", match[2])))


def plan_cases(options):
    """What to run: study, layout, and the override that sets the size (None where the input does)."""
    layouts = options.layouts
    cases = []
    if options.strong or not (options.weak or options.sizes):
        cases += [("strong", shape, None) for shape in layouts]
    if options.weak:
        key, values = options.weak
        if len(values) == 1:
            values = [multiplied(values[0], math.prod(shape) / math.prod(layouts[0])) for shape in layouts]
        if len(values) != len(layouts):
            raise ValueError(f"--weak {key}: {len(values)} values for {len(layouts)} layouts")
        cases += [("weak", shape, f"{key}={value}") for shape, value in zip(layouts, values)]
    if options.sizes:
        key, values = options.sizes
        cases += [("sizes", shape, f"{key}={value}") for value in values for shape in layouts]
    return [{"study": study, "ranks": ranks, "threads": threads, "size": size,
             "folder": f"{number:02d}_{study}_{ranks}x{threads}"}
            for number, (study, (ranks, threads), size) in enumerate(cases, 1)]


def compare_and_predict(rows, records, machines, beyond):
    """Adds speedup, efficiency and predicted time to the rows of a study over cores; returns rows for cores beyond.
    `machines`: with the network within a node, and between nodes."""
    machine = machines[0]
    first = min(rows, key=lambda row: row["cores"])
    real = [row for row in rows if row["cores"] <= row["nodes"] * machine.cores_per_node]
    problem = problem_of(records[rows.index(first)])
    rate = core_rate(problem, first) if problem else None
    rest = first["wall_s"] - first["solve_s"]  # start, output, pictures: taken as the same on any cores
    strong = first["study"] == "strong"

    def predicted(of, ranks, threads, steps):
        network = machines[nodes_of(ranks, threads, machine.cores_per_node) > 1]
        seconds = solve_seconds(of, ranks, threads, steps, rate, network)
        return None if seconds is None else rest + seconds

    for row, record in zip(rows, records):
        growth = row["p"] / first["p"] * first["cores"] / row["cores"]
        if not 0.9 < growth < 1.1:
            print(f"warning: weak scaling, {row['size']}: the size a core is {growth:.2f} times the first one's", file=sys.stderr)
        row["speedup"] = first["cores"] * first["wall_s"] / row["wall_s"] if strong else None
        row["efficiency"] = row["speedup"] / row["cores"] if strong else first["wall_s"] / row["wall_s"]
        if row not in real:
            print(f"warning: {row['ranks']}x{row['threads']} shares {row['nodes'] * machine.cores_per_node} cores: "
                  "its time is not that of so many cores", file=sys.stderr)
        elif rate and row is not first:
            row["predicted_wall_s"] = predicted(problem_of(record), row["ranks"], row["threads"], row["steps"])
            row["prediction_error"] = row["predicted_wall_s"] / row["wall_s"] - 1
    last = max(real or rows, key=lambda row: row["cores"])
    ahead = []
    for cores in beyond:
        if not rate or cores <= last["cores"] or cores % last["threads"]:
            continue
        grown = problem if strong else problem.grown(cores / first["cores"])
        wall = predicted(grown, cores // last["threads"], last["threads"], first["steps"])
        if wall is None:
            break
        speedup = first["cores"] * first["wall_s"] / wall if strong else None
        ahead.append({"study": first["study"], "ranks": cores // last["threads"], "threads": last["threads"], "cores": cores,
                      "nodes": nodes_of(cores // last["threads"], last["threads"], machine.cores_per_node), "runs": 0,
                      "p": cores if strong else first["p"] * cores / first["cores"], "predicted_wall_s": wall,
                      "core_hours": wall * cores / 3600, "speedup": speedup,
                      "efficiency": speedup / cores if strong else first["wall_s"] / wall})
    return ahead


def machine_of(found, options, cores_per_node, nodes):
    """The network of so many nodes: as stated; else as the runs on most ranks of one node, or of several, measured it; else
    as is usual. Ranks that share cores measure how they take turns, which is no network."""
    costs = [(row["ranks"], record["performance"]) for row, record in found
             if (row["nodes"] > 1) == (nodes > 1) and row["cores"] <= row["nodes"] * cores_per_node
             and record["performance"]["message_latency_s"]]
    best = [cost for ranks, cost in costs if ranks == max(ranks for ranks, _ in costs)]
    values, sources = [], set()
    for stated, key, usual in ((options.latency, "message_latency_s", 2e-6), (options.bandwidth, "message_bandwidth_B_s", 12.5e9)):
        values.append(stated or (statistics.median(cost[key] for cost in best) if best else usual))
        sources.add("as stated" if stated else "as measured" if best else "as usual, not measured")
    return Machine(*values, cores_per_node, " and ".join(sorted(sources)))


def collect(plan, output, options, cores_per_node, beyond):
    """Rows of the finished runs, and of predictions beyond them; says what is missing."""
    rows, ahead, model = [], [], None
    cases = [(case, *measured(plan, output, case)) for case in plan["cases"]]
    for case in (case for case, row, _ in cases if row is None):
        print(f"warning: no finished run in {output / 'runs' / case['folder']}", file=sys.stderr)
    complete = [(row, record) for _, row, record in cases if row]
    machines = [machine_of(complete, options, cores_per_node, nodes) for nodes in (1, 2)]
    for study in ("strong", "weak", "sizes"):
        found = [(row, record) for case, row, record in cases if row and case["study"] == study]
        if not found:
            continue
        of_study, records = map(list, zip(*found))
        model = model or records[0]["input"]["scene"]["model"]["value"]
        if study != "sizes":
            ahead += compare_and_predict(of_study, records, machines, beyond)
        rows += of_study
    if not rows:
        sys.exit(f"error: no finished run in {output}")
    write_report(output, plan, model, read_machine(output / "machine.txt"), machines, rows, ahead)


def parse_arguments():
    parser = Parser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("input", nargs="?", type=pathlib.Path, help="input file (TOML)")
    parser.add_argument("--strong", action="store_true", help="the input on every layout (done if nothing else is asked for)")
    parser.add_argument("--weak", type=key_and_values, metavar="KEY=VALUES", help="a size for each layout")
    parser.add_argument("--sizes", type=key_and_values, metavar="KEY=VALUES", help="every size on every layout")
    parser.add_argument("--layouts", type=layout, nargs="+", default=[(1, 1), (1, 2), (2, 1)], metavar="RANKSxTHREADS",
                        help="default: 1x1 1x2 2x1")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="passed on to every run")
    parser.add_argument("--repeat", type=positive(int), default=3, help="runs of each case, default 3")
    parser.add_argument("--program", type=pathlib.Path, default=PROGRAM)
    parser.add_argument("--launcher", type=shlex.split, metavar="COMMAND",
                        help="what starts ranks, before -n RANKS; default: mpirun, bound to cores")
    parser.add_argument("--slurm", type=pathlib.Path, metavar="DIR", help="write job scripts instead of running")
    parser.add_argument("--slurm-option", action="append", default=[], metavar="OPTION",
                        help="one more #SBATCH line, such as --slurm-option=--time=01:00:00")
    parser.add_argument("--collect", type=pathlib.Path, metavar="DIR", help="report on the finished jobs of DIR")
    parser.add_argument("--predict", type=positive(int), nargs="*", default=[2**k for k in range(1, 11)], metavar="CORES",
                        help="predict times on so many cores, default 2 to 1024")
    parser.add_argument("--latency", type=positive(float), help="of a message between nodes, s; default: as measured between them, or 2e-6")
    parser.add_argument("--bandwidth", type=positive(float), help="of a node, bytes/s; default: as measured, or 12.5e9")
    parser.add_argument("--cores-per-node", type=positive(int), help="default: this machine's")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=RESULTS / "scaling")
    options = parser.parse_args()
    if bool(options.input) == bool(options.collect):
        parser.error("give either an input file or --collect DIR")
    if options.collect and not (options.collect / "study.json").is_file():
        parser.error(f"{options.collect} holds no study.json: not a folder that --slurm made")
    if options.input and not options.input.is_file():
        parser.error(f"no file {options.input}")
    if options.input and not os.access(options.program, os.X_OK):
        parser.error(f"no program {options.program}: ./quickstart build, or --program")
    starter = (options.launcher or ["mpirun"])[0]
    if options.input and not options.slurm and not shutil.which(starter):
        parser.error(f"no command {starter}")
    if options.slurm and (options.slurm / "study.json").exists():
        parser.error(f"{options.slurm} holds a study already: collect it, or choose another folder")
    return parser, options


def main():
    parser, options = parse_arguments()
    beyond = sorted(set(options.predict))
    if options.collect:
        output = options.collect
        plan = json.loads((output / "study.json").read_text(encoding="utf-8"))
        cores_per_node = options.cores_per_node or plan["cores_per_node"]
    else:
        output = (options.slurm or options.output).resolve()
        cores_per_node = options.cores_per_node or os.cpu_count()
        try:
            plan = {"input": str(options.input.resolve()), "program": str(options.program.resolve()), "set": options.set,
                    "repeat": options.repeat, "cores_per_node": cores_per_node, "cases": plan_cases(options)}
            check_input(plan)
            output.mkdir(parents=True, exist_ok=True)
        except (ValueError, OSError) as problem:
            parser.error(str(problem))
        (output / "study.json").write_text(json.dumps(plan, indent=2) + "\n", encoding="utf-8")
        if options.slurm:
            write_jobs(plan, output, options.slurm_option)
            print(f"for job in {shlex.quote(str(output))}/*.sbatch; do sbatch \"$job\"; done   # then --collect {output}")
            return
        run_here(plan, output, options.launcher)
    collect(plan, output, options, cores_per_node, beyond)


if __name__ == "__main__":
    main()
