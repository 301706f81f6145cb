#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tries to make Rhexis crash, hang, lose something, or be wrong without a word.

    tests/robustness/robustness_study.py inputs --count 10000      mutated TOML, CSV, JSON and VTP files, --set arguments
    tests/robustness/robustness_study.py networks --count 10000    mutated files of a network, so many of each format
    tests/robustness/robustness_study.py checkpoints --count 1000  damaged checkpoints of a vessel, a two-way run and a cascade
    tests/robustness/robustness_study.py kills --count 50          kill -9 at random moments on 1 to 4 ranks, then a restart

What must hold: no signal, no hang, exit status 0, 2 or 3 only; after status 2 one message, and no file made, changed or removed;
nothing that is no number in what is called completed; a restart, from a damaged checkpoint too, gives the results of an
undisturbed run bit by bit, or is refused. Every case is a function of --seed and its number: `--first N --count 1` repeats one.
What does not hold is kept below --output, and makes the exit status 1. Ctrl-C or SIGTERM ends it early and reports. Needs python3-h5py.
"""

import argparse
import pathlib
import shutil
import signal
import sys
from concurrent.futures import ThreadPoolExecutor

import study.checkpoints
import study.inputs
import study.kills
import study.networks
from study.findings import Findings
from study.program import Program

ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDIES = {"inputs": study.inputs.study, "checkpoints": study.checkpoints.study, "kills": study.kills.study, "networks": study.networks.study}
MPIRUN = ("mpirun", "--oversubscribe", "--bind-to", "none", "--allow-run-as-root")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=STUDIES)
    parser.add_argument("--count", type=int, default=100, help="number of cases; default 100")
    parser.add_argument("--first", type=int, default=0, help="number of the first case; default 0")
    parser.add_argument("--seed", type=int, default=1, help="default 1")
    parser.add_argument("--jobs", type=int, default=2, help="cases at once; default 2")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/rhexis", help="default build/release/bin/rhexis")
    parser.add_argument("--output", type=pathlib.Path, help="folder for findings; default results/robustness/<study>")
    parser.add_argument("--no-memory-limit", action="store_true", help="for programs with the address sanitizer, which reserves terabytes")
    options = parser.parse_args()
    if not options.program.is_file():
        sys.exit(f"error: there is no {options.program}; build Rhexis, or name it by --program")
    output = options.output or ROOT / "results/robustness" / options.study
    output.mkdir(parents=True, exist_ok=True)
    for case in output.glob("case_*"):
        shutil.rmtree(case)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C
    program = Program(options.program.resolve(), MPIRUN)
    if options.no_memory_limit:
        program.memory_kib = "unlimited"
    with ThreadPoolExecutor(options.jobs) as pool:
        return STUDIES[options.study](program, Findings(output), options.seed, options.first, options.count, pool)


if __name__ == "__main__":
    sys.exit(main())
