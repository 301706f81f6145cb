# SPDX-License-Identifier: BSD-3-Clause
"""The runs of a scaling study: checked, started here or written as jobs for Slurm, and read."""

import json
import os
import re
import shlex
import statistics
import subprocess
import sys

from performance_model import nodes_of


def overrides(plan, case):
    return [word for text in (*plan["set"], *filter(None, [case["size"]])) for word in ("--set", text)]


def check_input(plan):
    """Every size, by the program itself, before anything is written."""
    for size in dict.fromkeys(case["size"] for case in plan["cases"]):
        command = [plan["program"], "check", plan["input"], *overrides(plan, {"size": size})]
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode:
            raise ValueError((result.stderr.strip() or f"{plan['program']} does not run").splitlines()[-1])


def run_folders(plan, output, case):
    return [output / "runs" / case["folder"] / str(repeat) for repeat in range(1, plan["repeat"] + 1)]


def run_command(plan, case, folder):
    return [plan["program"], "run", plan["input"], "-o", str(folder), "--quiet", *overrides(plan, case)]


def launcher(ranks, threads):
    """mpirun, with a core for every thread where there are enough."""
    enough = ranks * threads <= len(os.sched_getaffinity(0))
    binding = ["--map-by", f"slot:PE={threads}", "--bind-to", "core"] if enough else ["--bind-to", "none"]
    root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    return ["mpirun", "--oversubscribe", *root, *binding]


def run_here(plan, output, start_with):
    """Every case once, then every case again, so that what disturbs the machine for a while disturbs all alike."""
    (output / "machine.txt").write_text(describe_machine(plan["program"]), encoding="utf-8")
    if os.getloadavg()[0] > 0.5:
        print(f"warning: other programs keep {os.getloadavg()[0]:.1f} cores busy, which these times will feel", file=sys.stderr)
    for repeat in range(plan["repeat"]):
        for case in plan["cases"]:
            folder = run_folders(plan, output, case)[repeat]
            start = start_with or launcher(case["ranks"], case["threads"])
            print(f"{repeat + 1}/{plan['repeat']}  {case['folder']}  {case['size'] or ''}".rstrip(), flush=True)
            status = subprocess.run([*start, "-n", str(case["ranks"]), *run_command(plan, case, folder)],
                                    env={**os.environ, "OMP_NUM_THREADS": str(case["threads"])}).returncode
            if status:
                sys.exit(f"error: the run in {folder} ended with status {status}")


def describe_machine(program):
    english = {**os.environ, "LC_ALL": "C"}
    return "".join(subprocess.run(command, capture_output=True, text=True, env=english, check=True).stdout
                   for command in (["lscpu"], [program, "--version"]))


def write_jobs(plan, output, slurm_options):
    """A job script for each case, which runs all its repeats."""
    for case in plan["cases"]:
        nodes = nodes_of(case["ranks"], case["threads"], plan["cores_per_node"])
        per_task = f"--cpus-per-task={case['threads']}"
        header = [f"--job-name={case['folder']}", f"--nodes={nodes}", "--exclusive",
                  f"--ntasks={case['ranks']}", per_task, f"--output={output / case['folder']}.log", *slurm_options]
        program, machine = (shlex.quote(str(path)) for path in (plan["program"], output / "machine.txt"))
        lines = ["#!/bin/bash", *(f"#SBATCH {option}" for option in header), "set -e",
                 f"export OMP_NUM_THREADS={case['threads']}",
                 f"{{ LC_ALL=C lscpu; {program} --version; }} > {machine}"]
        for folder in run_folders(plan, output, case):
            lines.append(shlex.join(["srun", "--cpu-bind=cores", per_task, *run_command(plan, case, folder)]))
        (output / f"{case['folder']}.sbatch").write_text("\n".join(lines) + "\n", encoding="utf-8")


def read_machine(path):
    """What describe_machine wrote, in four entries."""
    words = {"cpu": r"Model name:", "cores": r"CPU\(s\):", "program": "Rhexis", "built": r" +built"}
    text = path.read_text(encoding="utf-8")
    found = {name: re.search(rf"^{start} +(.*)$", text, re.MULTILINE) for name, start in words.items()}
    return {name: match and match[1] for name, match in found.items()}


def measured(plan, output, case):
    """A row of medians over the finished runs of a case, and one of their records; (None, None) where none finished."""
    paths = [folder / "run.json" for folder in run_folders(plan, output, case)]
    records = [json.loads(path.read_text(encoding="utf-8")) for path in paths if path.exists()]
    records = [record for record in records if record["status"] == "completed"]
    if not records:
        return None, None
    costs = [record["performance"] for record in records]
    results = records[0]["results"]

    def median(key):
        return None if costs[0][key] is None else statistics.median(cost[key] for cost in costs)

    wall = median("wall_s")
    nodes = round(3600 * costs[0]["node_hours"] / costs[0]["wall_s"])
    cores = costs[0]["ranks"] * costs[0]["threads"]
    vessels = results["network"]["vessels"]
    row = {"study": case["study"], "size": case["size"], "ranks": costs[0]["ranks"], "threads": costs[0]["threads"],
           "cores": cores, "nodes": nodes, "particles": results["particles"], "vessels": vessels,
           "p": cores if case["study"] == "strong" else vessels or results["particles"],
           "steps": results["steps"] or 1, "runs": len(records), "wall_s": wall,
           "wall_min_s": min(cost["wall_s"] for cost in costs), "wall_max_s": max(cost["wall_s"] for cost in costs),
           "solve_s": median("solve_s"), "insitu_s": median("insitu_s"), "output_s": median("output_s"),
           "core_hours": wall * cores / 3600, "node_hours": wall * nodes / 3600, "flop": median("flop"),
           "peak_rss_bytes": median("peak_rss_bytes")}
    if row["p"] is None:
        sys.exit("error: without particles or vessels a run has no size: only --strong")
    return row, records[0]
