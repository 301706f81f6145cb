#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Two builds of Rhexis on every input of inputs/: a change that is to leave all results as they were is tried by this.

    tests/behaviour/compare_programs.py RHEXIS OTHER_RHEXIS [INPUT...] [--whole] [--no-pictures] [--keep FOLDER]

Runs each input by both programs, by the first also on 2 ranks where mpirun is there, and compares every number of history.csv,
run.json and the HDF5 files, and every picture: they must be identical, but for pictures of two ranks, which are composed of two
(a mean difference of 0.01 is allowed). What would take minutes is shortened, unless --whole is given: trees have fewer
generations, walls are shorter, ensembles smaller. Status 1: something differs.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocessing"))
from compare_runs import compare  # noqa: E402

FEW_GENERATIONS = ["tree.generations=16",
                   "tree.length_ratio_by_generation=[12, 13, 14, 15.1, 16.3, 17.6, 19, 20.5, 22.1, 23.9, 25.8, 27.8, 30.1, 32.5, 35, 37.8]"]
SHORTER = {
    "whole_body": [*FEW_GENERATIONS, "network.query=['artery.', 'vein.0110100101']"],
    "screening": [*FEW_GENERATIONS, "weakness.vessels=['artery.0110100101']"],
    "pd_cvdt": [*FEW_GENERATIONS, "time.end=1 ms", "load.ramp_time=0.9 ms"],
    "perivessel": ["output.movie=false"],
    "perivessel_100mm": ["vessel.length=14 mm", "time.end=1.5 ms", "load.ramp_time=1.3 ms"],
    "rupture_probability": ["ensemble.samples=2", "ensemble.pressure_count=3"],
    "cascade": ["cascade.events=2"],
}
# What says how fast, not what: these results are times on a clock.
CLOCKS = ("network_s", "exchange_s", "sample_s", "rank_seconds_per_sample")


def run(program, name, folder, settings, ranks):
    command = [program, "run", f"inputs/{name}.toml", "-o", folder, "--quiet", *(word for setting in settings for word in ("--set", setting))]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "--bind-to", "none", "--allow-run-as-root", "-n", str(ranks), *command]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr


def differences(folder, other, of_pictures):
    compared = list(compare(folder, other))
    far = [(file, value, apart) for file, value, apart in compared
           if apart > (of_pictures if file.suffix == ".png" else 0) and not value.endswith(CLOCKS)]
    return len(compared), far


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs=2, type=lambda path: str(pathlib.Path(path).resolve()), metavar="RHEXIS")
    parser.add_argument("inputs", nargs="*", help="names without .toml (default: all)")
    parser.add_argument("--whole", action="store_true", help="inputs as they are")
    parser.add_argument("--no-pictures", action="store_true", help="numbers only, which is quicker")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the results (default: a temporary one)")
    options = parser.parse_args()
    names = options.inputs or sorted(path.stem for path in (ROOT / "inputs").glob("*.toml"))
    folder = options.keep or pathlib.Path(tempfile.mkdtemp(prefix="rhexis_behaviour_"))
    failed = []
    for name in names:
        settings = [] if options.whole else SHORTER.get(name, [])
        if options.no_pictures and name != "rupture_probability":  # an ensemble draws none
            settings = [*settings, "insitu.enabled=false"]
        cases = [(program, ranks, folder / name / label) for program, ranks, label in
                 ((options.programs[0], 1, "one"), (options.programs[1], 1, "other"), (options.programs[0], 2, "two_ranks"))
                 if ranks == 1 or shutil.which("mpirun")]
        ends = [run(program, name, results, settings, ranks) for program, ranks, results in cases]
        for (_, ranks, results), (status, said) in list(zip(cases, ends))[1:]:
            count, far = differences(cases[0][2], results, of_pictures=0.01 if ranks > 1 else 0)
            same = ends[0][0] == status and count > 0 and not far
            print(f"{name:22} {results.name:10} status {ends[0][0]} and {status}, {count - len(far)} of {count} values identical"
                  f"{'' if same else '   DIFFERS'}", flush=True)
            for file, value, apart in far[:8]:
                print(f"    {file} {value}: {apart:.3g}")
            if status != ends[0][0] or count == 0:
                print("    " + said.strip().replace("\n", "\n    "))
            if not same:
                failed.append(name)
    if not options.keep:
        shutil.rmtree(folder)
    print("all identical" if not failed else f"different: {', '.join(dict.fromkeys(failed))}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
