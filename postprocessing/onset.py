# SPDX-License-Identifier: BSD-3-Clause
"""What verify.py and speed_against_error.py have in common: two discretisations, and when a wall of them begins to rupture."""

import json
import pathlib
import subprocess
import tempfile

import table_plot

ROOT = pathlib.Path(__file__).resolve().parent.parent
OURS = ("polar", "calibrated", "nonlocal")
PAPER = ("lattice", "none", "paper")


def settings(scheme):
    """Overrides that give a run this cross-section, surface correction and layer, and the paper's scheme the paper's dead load."""
    keys = ("discretisation.cross_section", "discretisation.surface_correction", "load.layer")
    direction = "dead" if scheme == PAPER else "follower"
    return [*(f"{key}={value}" for key, value in zip(keys, scheme)), f"load.direction={direction}"]


def run(build, *overrides, addition=""):
    """run.json and the columns of history.csv of inputs/vented_vessel.toml with `addition` at its end: --set reaches no [[spot]]."""
    with tempfile.TemporaryDirectory(prefix="rhexis_onset_") as folder:
        folder = pathlib.Path(folder)
        (folder / "input.toml").write_text((ROOT / "inputs/vented_vessel.toml").read_text() + addition)
        command = [build / "bin/rhexis", "run", folder / "input.toml", "-o", folder / "out", "--quiet"]
        for override in ("insitu.enabled=false", "output.fields=[]", *overrides):
            command += ["--set", override]
        subprocess.run(command, check=True)
        return json.loads((folder / "out/run.json").read_text()), table_plot.read(folder / "out/history.csv")


def onset(build, *overrides, pressure=320e3, ramp=2.4e-3):
    """On a ramp, of 3 mm of an endless vessel with 3 % of scatter over 0.25 mm: pressure (kPa) at which damage first reaches 0.2, what one
    time step adds to it, and core-seconds of solving until then; not numbers where it never does."""
    record, _ = run(build, "vessel.length=3 mm", "boundary.ends=axial_periodic", "scatter.correlation_length=0.25 mm",
                    f"load.pressure={pressure!r} Pa", f"load.ramp_time={ramp!r} s", f"time.end={ramp!r} s", *overrides)
    results, performance = record["results"], record["performance"]
    share = (results["rupture_onset_s"] or float("nan")) / ramp
    return {"kPa": share * pressure / 1e3, "step_kPa": results["time_step_s"] / ramp * pressure / 1e3,
            "core_s": performance["ranks"] * performance["threads"] * performance["solve_s"] * share}
