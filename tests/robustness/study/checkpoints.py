# SPDX-License-Identifier: BSD-3-Clause
"""Damaged checkpoints: refused with the name of what is damaged, or without effect on the results."""

import pathlib
import random
import shutil
import sys
import tempfile

from study import damage, scenes
from study.inputs import judge_ending
from study.program import changes, snapshot
from study.results import differences, found_by, newest_checkpoint


def checkpointed_scenes():
    """By name: files of a scene that leaves checkpoints before its end."""
    every = scenes.all_scenes()
    chosen = {"vessel": "vessel.table", "two_way": "two_way", "cascade": "cascade"}
    return {name: scenes.with_checkpoints(every[scene], 8) for name, scene in chosen.items()}


class Original:
    """A scene in a folder with a checkpoint, and what a restart from that finds."""

    def __init__(self, program, files, folder):
        self.folder = folder
        folder.mkdir()
        for name, text in files.items():
            (folder / name).write_text(text)
        whole = program.run(["run", "scene.toml", "-o", "whole", "--quiet"], folder)
        self.checkpoint = newest_checkpoint(folder / "whole")
        if whole.status != 0 or self.checkpoint is None:
            sys.exit(f"error: no checkpoint of {folder.name}: {whole.errors}")
        again = program.run(["run", "scene.toml", "-o", "again", "--quiet", "--restart", str(self.checkpoint)], folder)
        if again.status != 0:
            sys.exit(f"error: no restart of {folder.name}: {again.errors}")
        self.found = found_by(folder / "again")
        self.files = list(files)

    def copy(self, folder):
        for name in self.files:
            shutil.copy(self.folder / name, folder)
        damaged = folder / "damaged.h5"
        shutil.copy(self.checkpoint, damaged)
        return damaged


def run_case(program, original, kind, source, folder):
    damaged = original.copy(folder)
    names = kind(source, damaged)
    before = snapshot(folder)
    outcome = program.run(["run", "scene.toml", "-o", "out", "--quiet", "--restart", "damaged.h5"], folder)
    problems = judge_ending(outcome, {"files": {"damaged.h5": None}})
    if outcome.status == 2:
        problems += [f"after status 2: {change}" for change in changes(before, snapshot(folder))]
        if names and not any(name in outcome.errors for name in names):
            problems.append(f"does not name {' or '.join(names)}: {outcome.errors.strip()}")
    elif outcome.status == 0:
        problems += [f"changed result: {told}" for told in differences(original.found, found_by(folder / "out"))]
    elif outcome.ended_well():
        problems.append(f"failed later: {outcome.errors.strip()}")
    return outcome, problems


def study(program, findings, seed, first, count, pool):
    with tempfile.TemporaryDirectory(prefix="rhexis_study_") as scratch:
        originals = [Original(program, files, pathlib.Path(scratch) / name) for name, files in checkpointed_scenes().items()]

        def one(number):
            source = random.Random(f"{seed}:{number}")
            original, kind = source.choice(originals), source.choice(damage.KINDS)
            folder = pathlib.Path(tempfile.mkdtemp(prefix="rhexis_study_"))
            try:
                outcome, problems = run_case(program, original, kind, source, folder)
                details = {"scene": original.folder.name, "damage": kind.__name__, "run": vars(outcome)}
                findings.add(f"case_{number:06d}", (original.folder.name, kind.__name__, f"status {outcome.status}"), problems, details, folder)
            finally:
                shutil.rmtree(folder, ignore_errors=True)

        findings.of_each(pool, one, range(first, first + count))
    return findings.report("Damaged checkpoints")
