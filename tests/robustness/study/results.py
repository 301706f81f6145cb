# SPDX-License-Identifier: BSD-3-Clause
"""What a run found, in a form that two runs of one scene have in common bit by bit; times and the machine left out."""

import hashlib
import json
import pathlib
import re

import h5py

# Of run.json's results: what differs from run to run.
OF_THE_MACHINE = {"network_s", "exchange_s", "rank_seconds_per_sample", "samples_of_earlier_runs"}


def found_by(folder):
    """By file of the results folder: tables as bytes, results of records, the last moments of fields as digests."""
    folder = pathlib.Path(folder)
    found = {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*.csv")}
    for path in folder.rglob("run.json"):
        record = json.loads(path.read_text())
        found[str(path.relative_to(folder))] = (record["status"], without_times(record["results"]))
    for path in {series.parent for series in folder.rglob("particles*.h5")}:
        found[str(path.relative_to(folder) / "particles")] = last_moment(path)
    return found


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(inner) for key, inner in value.items() if key not in OF_THE_MACHINE}
    if isinstance(value, list):
        return [without_times(inner) for inner in value]
    return value


def last_moment(folder):
    """Digests of the fields at the last moment; a restart begins a series of its own."""
    newest = max(folder.glob("particles*.h5"), key=lambda path: int((re.findall(r"\d+", path.stem) or ["-1"])[-1]))
    with h5py.File(newest) as file:
        fields = {name: group for name, group in file.items() if isinstance(group, h5py.Group)}
        return {name: hashlib.sha256(group[max(group)][()].tobytes()).hexdigest() for name, group in fields.items() if len(group)}


def differences(expected, found):
    """Names of what differs, with what is told of it."""
    told = []
    for name in sorted(expected.keys() | found.keys()):
        a, b = expected.get(name), found.get(name)
        if a == b:
            continue
        if isinstance(a, bytes) and isinstance(b, bytes):
            rows = [(i, x, y) for i, (x, y) in enumerate(zip(a.split(b"\n"), b.split(b"\n")), 1) if x != y]
            told.append(f"{name} differs: " + (f"row {rows[0][0]}: {rows[0][1]!r} and {rows[0][2]!r}" if rows else f"{len(a)} and {len(b)} bytes"))
        elif a is None or b is None:
            told.append(f"{name} is {'new' if a is None else 'missing'}")
        else:
            told.append(f"{name} differs: {a} and {b}"[:1000])
    return told


def newest_checkpoint(folder):
    """By event and step; None where there is none."""
    return max(pathlib.Path(folder).rglob("checkpoints/*.h5"), default=None, key=lambda path: (str(path.parent), path.name))
