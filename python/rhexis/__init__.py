# SPDX-License-Identifier: BSD-3-Clause
"""Rhexis from Python: check and run input files, see a vessel while it runs, get results as a dict.

    import rhexis
    results = rhexis.run("inputs/vented_vessel.toml", {"load.pressure": "250 kPa"})
    print(results["rupture_onset_s"])

`overrides` are what --set takes, as {"section.key": value}: a quantity with its unit ("250 kPa"), a number that has none, a word,
True or False, or a list.
A call draws no pictures; the program does. Under mpirun every rank makes the same calls, and all get the same answers.

MPI starts with the first call and ends with Python. During a call OpenMP has the threads that OMP_NUM_THREADS asks for, signals are
the run's, and other Python threads go on; then all is as it was before. One call at a time.
"""

import atexit
import json
import pathlib
import sys
import tempfile

from . import _rhexis
from ._rhexis import InputError, Particles, RunError, Vessels, __version__, rank

__all__ = ["InputError", "Particles", "RunError", "Vessels", "__version__", "check", "rank", "run"]

# Python sets last_type where it ends by an exception.
atexit.register(lambda: _rhexis.end_mpi(hasattr(sys, "last_type")))


def _words(overrides):
    """As --set takes them; numpy's numbers and arrays too."""
    return [f"{key}={value if isinstance(value, str) else json.dumps(value, default=lambda array: array.tolist())}"
            for key, value in (overrides or {}).items()]


def check(file, overrides=None):
    """Reads and checks an input file and returns what it amounts to, as a dict: "model", "input" (all keys with their values in SI
    units) and "warnings"; for a single vessel and an ensemble also "particles", "steps", "time_step_s" and "stable_time_step_s".

    Raises InputError, which names file, line, key, value and what is allowed.
    """
    return json.loads(_rhexis.check(str(file), _words(overrides)))


def run(file, overrides=None, *, output=None, restart=None, overwrite=False, quiet=True, progress=None):
    """Runs what an input file describes and returns the results of its run.json (docs/results.md) as a dict.

    output     the folder for results, as of `rhexis run -o`; None: a temporary one, so that nothing is kept but what is returned
    restart    a checkpoint to go on from
    overwrite  replace files in the folder that no run made
    quiet      print errors only
    progress   is called as progress(particles, network) at every output of a vessel (output.every_steps), and of a network when it is
               solved, on every rank. Either is None where the run has none. particles["damage"] is an array of this rank's particles,
               particles["displacement"] three (x, y, z; m); network["flow"] is an array of its shown vessels (network.shown_vessels, m3/s),
               network["pressure"] of their junctions (Pa). `fields` has all names with units, `step`, `time_s` and `annotations` (the
               wall's "pressure", Pa) tell the moment. The arrays are the solver's memory, read-only, and end with the call: keep
               copies. What it raises ends the run, of a vessel after a checkpoint, and comes out of here.

    Raises InputError (a ValueError) for a wrong input, before anything is written, and RunError (a RuntimeError) for a run that fails.
    Ctrl-C makes the run save its state in `output` and end; then KeyboardInterrupt is raised. The solution of a network goes on to its
    end before. A third Ctrl-C ends Python at once.
    """
    with tempfile.TemporaryDirectory(prefix="rhexis_") as unused:
        folder = _rhexis.broadcast(str(output or unused))  # the first rank's, for all
        _rhexis.run(str(file), _words(overrides), folder, str(restart or ""), overwrite, quiet, progress)
        record = (pathlib.Path(folder) / "run.json").read_text(encoding="utf-8") if rank() == 0 else ""
        return json.loads(_rhexis.broadcast(record))["results"]
