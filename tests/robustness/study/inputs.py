# SPDX-License-Identifier: BSD-3-Clause
"""Mutated inputs: whatever is in them, a run ends by itself, tells what is wrong in one message, and takes nothing away."""

import csv
import json
import math
import pathlib
import random
import re
import shutil
import sys
import tempfile

from study import mutations, scenes
from study.program import changes, is_temporary, snapshot

MINE = "mine.txt"  # a file of the user's, in the results folder of half the cases
WITH_RESULTS = ("vessel", "cascade", "ensemble")  # scenes that are run again over results of theirs, one file of which is damaged
LARGEST_RUN_S, LARGEST_COST = 3, 3e7  # by check's own estimate; particles x steps
LONGEST_MESSAGE = 6000


def earlier_results(program, all_scenes):
    """By scene: the results of a run, as names below the folder with bytes."""
    results = {}
    for name in WITH_RESULTS:
        with tempfile.TemporaryDirectory(prefix="rhexis_study_") as folder:
            for file, text in all_scenes[name].items():
                (pathlib.Path(folder) / file).write_text(text)
            outcome = program.run(["run", "scene.toml", "-o", "out", "--quiet"], folder)
            if outcome.status != 0:
                sys.exit(f"error: {name} does not run: {outcome.errors}")
            results[name] = {file: data for file, data in snapshot(folder).items() if data is not None and file.startswith("out/")}
    return results


def make_case(seed, number, all_scenes, results, keys):
    """Name of the scene, its files as bytes, arguments, and which mutations made it: the same for the same seed and number."""
    source = random.Random(f"{seed}:{number}")
    kind = source.random()
    name = source.choice(sorted(results if kind > 0.93 else all_scenes))
    files = {file: text.encode() for file, text in all_scenes[name].items()}
    arguments, told, place = [], [], "scene.toml"
    others = [file for file in files if file != "scene.toml"]
    if kind > 0.93:
        texts = [file for file in results[name] if file.endswith((".csv", ".json", ".txt"))]
        place = source.choice([file for file in texts if file.endswith(("manifest.txt", "samples.csv"))] * 3 + texts)
        files.update(results[name])
        files[place], told = mutations.mutate_file(source, place, results[name][place].decode(), keys)
    elif kind < 0.12:
        place = "--set"
        for _ in range(source.choice((1, 1, 2))):
            arguments += ["--set", mutations.argument(source, keys)]
    else:
        if others and kind < 0.65:
            place = source.choice(others)
        files[place], told = mutations.mutate_file(source, place, all_scenes[name][place], keys)
    return {"scene": name, "files": files, "arguments": arguments, "mutated": place, "mutations": told}


def run_case(program, case, folder, earlier):
    """Outcomes of check and run (None where it would take long) in `folder`, and what must not be."""
    for name, data in case["files"].items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    if earlier:
        (folder / "out").mkdir(exist_ok=True)
        (folder / "out" / MINE).write_text("not yours\n")
    before = snapshot(folder)
    users = {name: data for name, data in before.items() if not name.startswith("out/") or name.endswith(MINE)}
    check = program.run(["check", "scene.toml", *case["arguments"]], folder)
    problems = [f"check {problem}" for problem in judge_ending(check, case)]
    problems += [f"check wrote: {change}" for change in changes(before, snapshot(folder))]
    run = None
    if check.ended_well() and not takes_long(check.output):
        run = program.run(["run", "scene.toml", "-o", "out", "--quiet", *case["arguments"]], folder)
        problems += judge_ending(run, case)
        problems += judge_results(run, check, folder, before, users)
    return check, run, problems


def judge_ending(outcome, case):
    """What is wrong with how it ended and with what it said."""
    if outcome.status is None:
        return ["does not end"]
    if not outcome.ended_well():
        return [f"ended with {outcome.status}"]
    problems = [] if outcome.output_is_text else ["wrote bytes that are no text"]
    lines = [line for line in outcome.errors.splitlines() if line.startswith("rhexis: ") and not line.startswith("rhexis: warning: ")]
    if len(outcome.errors) > LONGEST_MESSAGE:
        problems.append(f"wrote {len(outcome.errors)} characters of errors")
    if outcome.status == 0:
        return problems + ([f"says of a success: {lines[0]}"] if lines else [])
    if len(lines) != 1:
        return [*problems, f"{len(lines)} error messages"]
    if outcome.status == 2 and not any(name in lines[0] for name in (*case["files"], "--set", "to out: ")):
        problems.append(f"names no file: {lines[0]}")
    return problems


def takes_long(output):
    """Whether check's estimate says so: a valid scene, however large, is no fault."""
    def numbers(pattern):
        return [float(found.replace(",", "")) for found in re.findall(pattern, output)]

    def highest(pattern):
        return max(numbers(pattern), default=1)

    time = re.search(r"^  time +(?:at most )?about ([\d.,]+) (\w+)", output, re.MULTILINE)
    if time and (time.group(2) != "s" or float(time.group(1).replace(",", "")) > LARGEST_RUN_S):
        return True
    cost = highest(r"particles +([\d,]+)") * highest(r"([\d,]+) steps") * highest(r"samples +([\d,]+)")
    return cost > LARGEST_COST or highest(r"outputs +([\d,]+)") > 300 or highest(r"of (\d+) generations") > 16


def judge_results(run, check, folder, before, users):
    """What is wrong with what the run left, given its status."""
    after = snapshot(folder)
    if run.status == 2:
        problems = [f"after status 2: {change}" for change in changes(before, after)]
        refused_late = check.status == 0 and before.keys() == users.keys()  # check does not look at results
        return problems + (["check passed what run refuses"] if refused_late else [])
    problems = [f"the user's: {change}" for change in changes(users, {name: data for name, data in after.items() if name in users})]
    if not (folder / "out/run.json").exists():
        return [*problems, "no record"] if run.status == 0 else problems
    try:
        record = json.loads((folder / "out/run.json").read_text(), parse_constant=lambda word: problems.append(f"record holds: {word}"))
    except ValueError as error:
        return [*problems, f"record is no JSON: {error}"]
    status = record["status"]
    if (run.status == 0) != (status == "completed"):
        problems.append(f"record does not fit status {run.status}: {status}")
    if status == "completed":
        problems += [f"completed with: {place}" for place in not_finite(folder / "out", record)]
    problems += [f"left over: {name}" for name in after if is_temporary(name)]
    return problems


def not_finite(folder, record):
    """Numbers of a completed run's tables that are none, and totals that its record should hold."""
    for table in sorted(pathlib.Path(folder).rglob("*.csv")):
        with open(table, encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                for name, text in row.items():
                    try:
                        finite = text is None or math.isfinite(float(text))
                    except ValueError:
                        continue  # a name
                    if not finite and name not in ("from", "to"):  # the outer bins of a histogram have no end
                        yield f"{table.name}: {name} = {text}"
    for name in ("energy_drift", "steps", "particles"):
        if name in record["results"] and record["results"][name] is None and record["input"]["scene"]["model"] == "vessel":
            yield f"run.json: {name} = null"


def study(program, findings, seed, first, count, pool):
    all_scenes, keys = scenes.all_scenes(), program.keys()
    results = earlier_results(program, all_scenes)

    def one(number):
        case = make_case(seed, number, all_scenes, results, keys)
        folder = pathlib.Path(tempfile.mkdtemp(prefix="rhexis_study_"))
        try:
            check, run, problems = run_case(program, case, folder, earlier=number % 2 == 0)
            mutated = case["mutated"] if case["mutated"] == "--set" else pathlib.Path(case["mutated"]).suffix
            told = f"run {run.status}" if run else "no run: check did not end well" if not check.ended_well() else "no run: it would take long"
            details = {"scene": case["scene"], "arguments": case["arguments"], "mutated": case["mutated"], "mutations": case["mutations"],
                       "check": vars(check), "run": run and vars(run)}
            if run and run.status == 3:
                findings.note(run.errors)
            findings.add(f"case_{number:06d}", (mutated, f"check {check.status}", told), problems, details, folder)
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    findings.of_each(pool, one, range(first, first + count))
    return findings.report("Mutated inputs")
