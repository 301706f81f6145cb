#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Benchmarks of this machine, here and now: bonds, networks, output and pictures, beside what the machine can do.

    apt-get install libbenchmark-dev
    cmake --preset release -DRHEXIS_BENCHMARKS=ON && cmake --build --preset release
    postprocessing/benchmarks.py [--build build/release] [--quick] [-o results/benchmarks]

Runs bench_machine, bench_bonds, bench_network and bench_output of the build (sources in tests/bench, which say what is
measured), and short runs with few and with more pictures, of which the quickest count. Other values are medians: on one thread of
processor time, on several of wall-clock time, which feels whatever else runs. The peak is measured right before and after each sample that is
compared with it, for the clock of a shared machine swings. Writes benchmarks.json and benchmarks.md, the table that it also
prints. --quick takes few samples, less than a minute in all.
"""

import argparse
import datetime
import json
import os
import pathlib
import re
import subprocess
import sys

from scaling_runs import describe_machine, read_machine

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAMS = ("bench_machine", "bench_bonds", "bench_network", "bench_output")
SAMPLES, QUICK_SAMPLES = 31, 3
PICTURE_ROUNDS, QUICK_PICTURE_ROUNDS = 4, 1
QUICK_FILTER = "-rows=1000|across=10|tier=explicit|memory=|outputs="  # all but these


def run_program(program, output, quick):
    """Its cases, as Google Benchmark reports them, and the context that they were run in."""
    report = output / f"{program.name}.json"
    options = ["--samples", str(QUICK_SAMPLES), f"--benchmark_filter={QUICK_FILTER}"] if quick else ["--samples", str(SAMPLES)]
    done = subprocess.run([program, *options, "--scratch", output, f"--benchmark_out={report}", "--benchmark_out_format=json"],
                          capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"error: {program.name} ended with status {done.returncode}: {done.stderr.strip()}")
    return json.loads(report.read_text(encoding="utf-8"))


def case_of(benchmark):
    """A case of ours: what its name says, and its counters."""
    words = benchmark["name"].split("/")
    keys = dict(word.split("=", 1) for word in words if "=" in word)
    theirs = {"family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads", "iterations", "real_time", "cpu_time"}
    counters = {key: value for key, value in benchmark.items() if isinstance(value, (int, float)) and key not in theirs}
    return {"what": words[0], **keys, "samples": benchmark["iterations"], **counters}


def pictures(program, output, rounds):
    """Seconds of a picture and of ParaView's start, from runs of 100 steps with 2 and with 11 pictures, the quickest of those that
    take turns for `rounds`: ParaView's start alone varies by more than pictures cost. None without ParaView."""
    runs = {100: [], 10: []}  # by steps between pictures
    for every in (100, 10) * rounds:
        folder = output / f"pictures_{every}"
        overrides = ("time.end=50 us", "output.every_steps=100000", "output.fields=[]", "output.movie=false", f"insitu.every_steps={every}")
        subprocess.run([program, "run", ROOT / "inputs/perivessel.toml", "-o", folder, "--quiet",
                        *(word for override in overrides for word in ("--set", override))], check=True)
        runs[every].append(json.loads((folder / "run.json").read_text(encoding="utf-8")))
    few, many = (len(list((output / f"pictures_{every}/images").glob("*.png"))) for every in runs)
    if few == many:
        return None
    first, second = (min(run["performance"]["insitu_s"] for run in of) for of in runs.values())
    record = min(runs[100], key=lambda run: run["performance"]["solve_s"])
    picture = (second - first) / (many - few)
    step = record["performance"]["solve_s"] / record["results"]["steps"]
    return {"what": "pictures", "s_per_picture": picture, "start_s": first - few * picture,
            "steps_per_picture": picture / step, "threads": record["performance"]["threads"]}


def machine_of(program, output, context):
    """CPU, cores, caches, memory; the program's version and how it was built."""
    file = output / "machine.txt"
    file.write_text(describe_machine(program), encoding="utf-8")
    caches = {f"L{cache['level']} {cache['type'].lower()}": cache["size"] for cache in context["caches"]}
    return {**read_machine(file), "caches_bytes": caches,
            "memory_bytes": os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")}


def number(value, factor=1, digits=3):
    return "-" if value is None else f"{value * factor:#.{digits}g}".rstrip(".")


def percent(share):
    return "-" if share is None else f"{100 * share:.{0 if share >= 0.1 else 1}f} %"


def table(header, rows):
    lines = [f"| {' | '.join(header)} |", f"|{' --- |' * len(header)}"]
    return "\n".join(lines + [f"| {' | '.join(map(str, row))} |" for row in rows])


def bond_row(c):
    wall = f"{c['section']} {c['across']}, {c['rows']} rows" + (", scattered" if c["wall"] == "scattered" else "")
    damage = re.sub(r"(\d+)$", r" \1 %", c["damage"])
    return (wall, c["bonds"], c["law"], damage, c["threads"], number(c["bonds_per_s"], 1e-9), number(c["flop_per_s"], 1e-9),
            number(c["ns_per_particle_step"]), percent(c["of_peak"]), percent(c.get("of_arithmetic")))


def network_row(c):
    what = f"{c['generations']} generations, {c['way']}" if c["tier"] == "implicit" else c["graph"].replace("_", " ")
    return (c["tier"], what, f"{c['vessels']:,.0f}", c["threads"], number(c["vessels_per_s"], 1e-6), number(c["ns_per_vessel"]),
            percent(c["of_peak"]))


def output_row(c):
    frame = f"{c['frame']}, {c['threads']} thread{'s' * (c['threads'] != '1')}" if "threads" in c else c["frame"]
    return (frame, f"{c['particles']:,.0f}", number(c.get("bytes"), 1e-6), number(c["ms_per_frame"]), number(c.get("bytes_per_s"), 1e-6),
            percent(c["of_peak"]))


def machine_row(c):
    (kind, which), = ((key, c[key]) for key in ("fma", "load", "memory") if key in c)
    name = {"fma": f"fused multiply-adds, {which}", "load": f"loads from {which}", "memory": "memory, triad"}[kind]
    return (name, c["threads"], number(c["rate"], 1e-9), number(c["best"], 1e-9), "Gflop/s" if kind == "fma" else "GB/s")


def series_row(c):
    return (c["format"], c["outputs"], number(c["ms_to_lay_out"], 1e-3), *(number(c[f"ms_at_{at}"]) for at in (10, 1000, 10000)))


def pictures_row(c):
    return (number(c["s_per_picture"]), number(c["steps_per_picture"]), number(c["start_s"]), c["threads"])


TABLES = (
    ("machine", ("peak", "threads", "median", "best", ""), machine_row),
    ("bonds", ("wall", "bonds", "law", "damage", "threads", "Gbonds/s", "Gflop/s", "ns a particle and step", "of FMA peak", "of arithmetic"), bond_row),
    ("network", ("tier", "network", "vessels", "threads", "million vessels/s", "ns a vessel", "of FMA peak (implicit), of memory (explicit)"), network_row),
    ("output", ("frame", "particles", "MB", "ms", "MB/s", "of plain writing (fields: of FMA peak)"), output_row),
    ("series", ("format", "outputs of 100 particles", "s to lay out", "ms of the 10th", "of the 1,000th", "of the 10,000th"), series_row),
    ("pictures", ("s a picture", "steps in that time", "ParaView's start, s", "threads"), pictures_row),
)


def report(results):
    """The results as markdown."""
    m = results["machine"]
    caches = ", ".join(f"{name} {size / 1024:,.0f} KiB" for name, size in m["caches_bytes"].items())
    parts = [f"{m['cpu']}, {m['cores']} cores, {caches}, {m['memory_bytes'] / 2**30:.0f} GiB; "
             f"Rhexis {m['program']} ({m['built']}); {results['time']}, load {results['load'][0]:.1f} before and "
             f"{results['load'][1]:.1f} after."]
    for what, header, row in TABLES:
        rows = [row(case) for case in results["cases"] if case["what"] == what]
        if rows:
            parts.append(table(header, rows))
    return "\n\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release", help="folder of the build (default: build/release)")
    parser.add_argument("--quick", action="store_true", help="few samples, less than a minute")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/benchmarks")
    options = parser.parse_args()
    programs = [(options.build / "bin" / name).resolve() for name in (*PROGRAMS, "rhexis")]
    missing = [program.name for program in programs if not program.exists()]
    if missing:
        print(f"error: {options.build}/bin has no {', '.join(missing)}: apt-get install libbenchmark-dev; "
              f"cmake -B {options.build} -DRHEXIS_BENCHMARKS=ON && cmake --build {options.build}", file=sys.stderr)
        return 2
    output = options.output.resolve()
    output.mkdir(parents=True, exist_ok=True)
    load = [os.getloadavg()[0]]
    if load[0] > 0.5:
        print(f"warning: other programs keep {load[0]:.1f} cores busy, which these numbers will feel", file=sys.stderr)
    *benchmarks, rhexis = programs
    cases = []
    for program in benchmarks:
        print(program.name, file=sys.stderr)
        found = run_program(program, output, options.quick)
        context = found["context"]
        cases += [case_of(benchmark) for benchmark in found["benchmarks"]]
    cases += filter(None, [pictures(rhexis, output, QUICK_PICTURE_ROUNDS if options.quick else PICTURE_ROUNDS)])
    results = {"machine": machine_of(rhexis, output, context), "time": datetime.datetime.now().astimezone().isoformat(timespec="seconds"),
               "load": [*load, os.getloadavg()[0]], "cases": cases}
    (output / "benchmarks.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    text = report(results)
    (output / "benchmarks.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
