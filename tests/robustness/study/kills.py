# SPDX-License-Identifier: BSD-3-Clause
"""Runs killed at random moments, and gone on with: on other ranks, to the results of an undisturbed run bit by bit."""

import pathlib
import random
import shutil
import signal
import sys
import tempfile
import threading
import time
import xml.etree.ElementTree

from study import scenes
from study.program import Outcome, is_temporary, is_text, kill_all
from study.results import differences, found_by, newest_checkpoint

SIGNALS = (signal.SIGKILL,) * 8 + (signal.SIGTERM, signal.SIGUSR1)
RANKS = (1, 2, 3, 4)


def long_scenes():
    """By name: files of scenes that last a second or two, with checkpoints."""
    every = scenes.all_scenes()
    times = {"end": 'end = "1.6 ms"', "ramp_time": 'ramp_time = "0.8 ms"', "every_steps": "every_steps = 20"}
    ensemble = scenes.replaced(every["ensemble"]["scene.toml"], samples="samples = 40", end='end = "0.5 ms"', ramp_time='ramp_time = "0.4 ms"')
    return {
        "vessel": scenes.with_checkpoints(every["vessel.table"], 100, end='end = "2 ms"', every_steps="every_steps = 50"),
        **{name: scenes.with_checkpoints(every[name], 20, **times) for name in ("one_way", "two_way", "cascade")},
        "ensemble": {"scene.toml": ensemble},
    }


def command(folder, *more):
    return ["run", "scene.toml", "-o", folder, "--quiet", *more]


class Undisturbed:
    """What a scene's run finds that nobody kills, and how long it takes on so many ranks."""

    def __init__(self, program, files, folder):
        self.program, self.files, self.folder, self.seconds = program, files, folder, {}
        self.lock = threading.Lock()
        self.name = folder.name
        self.found = self.measure(1)

    def measure(self, ranks):
        folder = self.folder / str(ranks)
        write(self.files, folder)
        outcome = self.program.run(command("out"), folder, ranks)
        if outcome.status != 0:
            sys.exit(f"error: {self.name} does not run: {outcome.errors}")
        self.seconds[ranks] = outcome.seconds
        return found_by(folder / "out")

    def duration(self, ranks):
        with self.lock:
            if ranks not in self.seconds:
                self.measure(ranks)
            return self.seconds[ranks]


def write(files, folder):
    folder.mkdir(parents=True)
    for name, text in files.items():
        (folder / name).write_text(text)


def run_until(program, folder, ranks, moment_s, number):
    """Starts the scene, and sends all its processes the signal after so many seconds."""
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="rhexis_study_") as sessions:
        process = program.start(command("out"), folder, sessions, ranks)
        time.sleep(moment_s)
        early = process.poll() is None
        if early:
            kill_all(process, number)
        output, errors = process.communicate(timeout=program.seconds)
    errors = errors.decode("utf-8", "replace")
    return early, Outcome(process.returncode, output.decode("utf-8", "replace"), errors, time.monotonic() - begin, is_text(output))


def is_whole_xml(path):
    try:
        xml.etree.ElementTree.parse(path)
    except xml.etree.ElementTree.ParseError:
        return False
    return True


def go_on(program, folder, ranks):
    """The run that ends what is in the folder: from its newest checkpoint, or from the beginning; a finished one is let be."""
    checkpoint = newest_checkpoint(folder / "out")
    more = ["--restart", str(checkpoint.relative_to(folder))] if checkpoint else []
    return checkpoint, program.run(command("out", *more), folder, ranks)


def study(program, findings, seed, first, count, pool):
    with tempfile.TemporaryDirectory(prefix="rhexis_study_") as scratch:
        undisturbed = [Undisturbed(program, files, pathlib.Path(scratch) / name) for name, files in long_scenes().items()]

        def one(number):
            source = random.Random(f"{seed}:{number}")
            scene, sent = undisturbed[number % len(undisturbed)], source.choice(SIGNALS)
            ranks, others = source.choice(RANKS), source.choice(RANKS)
            place = pathlib.Path(tempfile.mkdtemp(prefix="rhexis_study_"))
            folder = place / scene.name
            try:
                write(scene.files, folder)
                moment = source.uniform(0.1, 1) * scene.duration(ranks)
                early, killed = run_until(program, folder, ranks, moment, sent)
                problems = [f"killed: {path.name} is no XML" for path in folder.rglob("*.xdmf") if not is_whole_xml(path)]
                checkpoint, again = go_on(program, folder, others) if early else (None, killed)
                if again.status == 0:
                    problems += differences(scene.found, found_by(folder / "out"))
                else:
                    problems.append(f"the run that goes on ended with {again.status}: {again.errors.strip()}")
                problems += [f"left over: {path.name}" for path in folder.rglob("*") if is_temporary(path.name)]
                told = "ended before" if not early else "from a checkpoint" if checkpoint else "without a checkpoint"
                details = {"signal": sent.name, "moment_s": moment, "ranks": ranks, "then": others, "checkpoint": checkpoint,
                           "killed": vars(killed), "again": vars(again)}
                findings.add(f"case_{number:06d}", (scene.name, sent.name, told), problems, details, folder)
            finally:
                shutil.rmtree(place, ignore_errors=True)

        findings.of_each(pool, one, range(first, first + count))
    return findings.report("Killed runs")
