#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's vessel by Rhexis and by LAMMPS peri/pmb, in turns: speed, displacements, energies, onset of rupture.

    apt-get install --no-install-recommends lammps
    postprocessing/compare_peers.py [--program build/release/bin/rhexis] [--cores 2] [--repeat 3] [-o results/peers]

Both get the same particles, bonds, material, load, ends and time step (inputs/perivessel.toml). Speed: the whole
vessel, some hundred steps. Physics: a short one, on the same ramp but until it tears. LAMMPS runs twice: "matched",
as near to the paper's scheme as it can be set, and "as is", with its weights at the horizon's edge and its contact.
Writes peers.json, peers.csv, peers.png and LAMMPS' inputs. Some six minutes on two cores.
"""

import argparse
import csv
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

import table_plot  # before pyplot: settles how matplotlib draws

import h5py
import matplotlib.pyplot as plt
import numpy as np

import lammps_peri

ROOT = pathlib.Path(__file__).resolve().parent.parent
RUPTURE_DAMAGE = 0.2
RHEXIS, MATCHED, AS_IS = "Rhexis", "LAMMPS matched", "LAMMPS as is"
LATTICE = {MATCHED: 1e-3, AS_IS: 1.0}  # LAMMPS' lattice constant, in spacings
RHEXIS_STEPS = 5  # times as many steps as LAMMPS' in a timing, so that both take a measurable time
COLUMNS = {"ring_mean_m": "mean radial displacement", "ring_max_m": "largest radial displacement",
           "strain_J": "strain energy", "kinetic_J": "kinetic energy"}
DIFFERENCES = """\
What still differs between Rhexis and LAMMPS matched:
- LAMMPS tests a bond after it has added its force, Rhexis before, as Eq. (5) says: a bond acts one step longer there.
- LAMMPS breaks where the stretch exceeds the critical one, Rhexis also where it equals it (never met in practice).
- Rhexis computes bonds in single precision (double: discretisation.bond_precision), LAMMPS in double.
- Sums are taken in another order. A bond near its critical stretch may break a step sooner or later for that, and
  from the first crack on the motion is chaotic: compare the curves only until the onset of rupture.
LAMMPS as is has also, with its lattice constant equal to the spacing:
- less weight for bonds within half a spacing of the horizon (down to a half), with the same c: a softer wall;
- repulsion between particles nearer than 0.9 of their first distance or 1.35 spacings, 15 times as stiff as a bond:
  it can act before the rupture, since the wall gets thinner as it widens."""


def lammps():
    """The LAMMPS program with peri/pmb, or the end of the script."""
    program = shutil.which("lmp")
    if not program:
        print("error: no LAMMPS (lmp) here; apt-get install lammps", file=sys.stderr)
        sys.exit(2)
    if "peri/pmb" not in subprocess.run([program, "-h"], capture_output=True, text=True).stdout:
        print(f"error: {program} has no pair style peri/pmb; apt-get install lammps, whose build has it", file=sys.stderr)
        sys.exit(2)
    return program


def rhexis(program, folder, cores, *overrides):
    """Runs inputs/perivessel.toml without pictures; returns run.json."""
    command = [program, "run", ROOT / "inputs/perivessel.toml", "-o", folder, "--quiet"]
    for override in ("insitu.enabled=false", "discretisation.surface_correction=none", *overrides):
        command += ["--set", override]
    subprocess.run(command, check=True, env={**os.environ, "OMP_NUM_THREADS": str(cores)})
    return json.loads((pathlib.Path(folder) / "run.json").read_text())


def wall(program, *overrides):
    """The particles that Rhexis makes, as LAMMPS needs them."""
    with tempfile.TemporaryDirectory(prefix="rhexis_peers_") as folder:
        record = rhexis(program, folder, 1, "time.end=10 us", "output.fields=[\"damage\"]", "output.precision=double", *overrides)
        with h5py.File(pathlib.Path(folder) / "particles.h5") as file:
            return lammps_peri.wall_of(record, file["reference_position"][:].astype(float))


def speed(options, program):
    """Steps per second of both, in turns, on the whole vessel."""
    whole = wall(program)
    steps = {RHEXIS: RHEXIS_STEPS * options.timing_steps, MATCHED: options.timing_steps}
    rates = {RHEXIS: [], MATCHED: []}
    for _ in range(options.repeat):
        with tempfile.TemporaryDirectory(prefix="rhexis_peers_") as folder:
            record = rhexis(program, folder, options.cores, f"time.end={steps[RHEXIS] * whole.time_step!r} s",
                            "output.fields=[]", "output.every_steps=1000000")
            rates[RHEXIS].append(steps[RHEXIS] / record["performance"]["solve_s"])
        with tempfile.TemporaryDirectory(prefix="rhexis_peers_") as folder:
            seconds, bonds = lammps_peri.run(options.lammps, folder, whole, steps[MATCHED], LATTICE[MATCHED] * whole.spacing, options.cores)
            rates[MATCHED].append(steps[MATCHED] / seconds)
    if bonds != 2 * record["results"]["bonds"]:
        raise RuntimeError(f"LAMMPS has {bonds} directed bonds, Rhexis {2 * record['results']['bonds']}")
    ratios = [ours / theirs for ours, theirs in zip(rates[RHEXIS], rates[MATCHED])]
    summary = lambda values: {"median": statistics.median(values), "least": min(values), "most": max(values), "all": values}
    return {"particles": len(whole.positions), "directed_bonds": bonds, "cores": options.cores, "steps": steps,
            "steps_per_s": {name: summary(values) for name, values in rates.items()}, "ratio": summary(ratios)}


def first_time(reached, time_step):
    """When a condition, given for every step, first holds."""
    hit = np.flatnonzero(reached)
    return float(hit[0] * time_step) if len(hit) else None


def physics(options, program):
    """Histories (columns by name) and events of all codes, on a short vessel until it tears."""
    end = options.end * 1e-3
    overrides = [f"vessel.length={options.length!r} mm", f"time.end={end!r} s", f"output.every_steps={options.every}",
                 f"load.ramp_time={end!r} s", f"load.pressure={238e3 * end / 2.25e-3!r} Pa"]
    short = wall(program, f"vessel.length={options.length!r} mm", *overrides[3:])
    ring = short.ring()
    histories, events = {}, {}

    with tempfile.TemporaryDirectory(prefix="rhexis_peers_") as folder:
        record = rhexis(program, folder, options.cores, "output.fields=[\"displacement\"]", *overrides)
        table = table_plot.read(pathlib.Path(folder) / "history.csv")
        with h5py.File(pathlib.Path(folder) / "particles.h5") as file:
            displacements = np.array([file[f"displacement/{int(step):06d}"][:][ring, :2] for step in table["step"]], dtype=float)
    histories[RHEXIS] = {"time_s": table["time_s"], **lammps_peri.ring_columns(displacements, short.positions[ring, :2]),
                         **{name: table[name] for name in ("kinetic_J", "strain_J", "max_damage")}}
    events[RHEXIS] = {"first_break_s": record["results"]["first_bond_break_s"], "onset_s": record["results"]["rupture_onset_s"]}

    for name, lattice in LATTICE.items():
        folder = options.output / name.lower().replace(" ", "_")
        lammps_peri.run(options.lammps, folder, short, record["results"]["steps"], lattice * short.spacing, options.cores, options.every)
        histories[name], damage = lammps_peri.read_history(folder, short)
        events[name] = {"first_break_s": first_time(damage > 0, short.time_step),
                        "onset_s": first_time(damage >= RUPTURE_DAMAGE, short.time_step)}
    for name, event in events.items():
        if event["onset_s"]:
            event["ring_mean_at_onset_m"] = float(np.interp(event["onset_s"], histories[name]["time_s"], histories[name]["ring_mean_m"]))
    return histories, events


def deviations(histories, name, until):
    """Largest difference of each curve from Rhexis' before a time, relative to the largest value of Rhexis' until then."""
    ours, theirs = histories[RHEXIS], histories[name]
    within = ours["time_s"] < until
    return {key: float(np.abs(theirs[key] - ours[key])[within].max() / ours[key][within].max()) for key in COLUMNS}


def deviations_before_events(histories, events, name):
    """The same before either code's first break, and before either's onset of rupture; where none, over all time."""
    found = {}
    for event in ("first_break_s", "onset_s"):
        until = min(events[code][event] or histories[RHEXIS]["time_s"][-1] for code in (RHEXIS, name))
        found[event] = {"until_s": float(until), **deviations(histories, name, until)}
    return found


def draw(histories, events, path):
    style = {RHEXIS: ("#1f5fa8", "-", 3.5), MATCHED: ("#e08214", "--", 1.6), AS_IS: ("#7a7a7a", "-", 1.2)}
    onset = events[RHEXIS]["onset_s"] or histories[RHEXIS]["time_s"][-1]
    figure, ((displacement, difference), (energy, damage)) = plt.subplots(2, 2, figsize=(10, 7), layout="constrained", sharex=True)
    for name, history in histories.items():
        colour, line, width = style[name]
        time = 1e3 * history["time_s"]
        look = {"color": colour, "linestyle": line, "linewidth": width, "label": name}
        displacement.plot(time, 1e3 * history["ring_mean_m"], **look)
        energy.plot(time, 1e3 * history["strain_J"], **look)
        damage.plot(time, history["max_damage"], **look)
        if name != RHEXIS:
            for key, dots in (("ring_mean_m", "-"), ("strain_J", ":")):
                scale = histories[RHEXIS][key][histories[RHEXIS]["time_s"] <= onset].max()
                difference.semilogy(time[1:], np.abs(history[key] - histories[RHEXIS][key])[1:] / scale, dots, color=colour,
                                    label=f"{name}, {COLUMNS[key]}")
        if events[name]["onset_s"]:
            for axes in (displacement, energy, damage, difference):
                axes.axvline(1e3 * events[name]["onset_s"], color=colour, linestyle=line, linewidth=1, alpha=0.7)
    until = histories[RHEXIS]["time_s"] <= onset
    displacement.set(ylabel="mean radial displacement,\nmiddle ring (mm)", ylim=(0, 2e3 * histories[RHEXIS]["ring_mean_m"][until].max()))
    energy.set(ylabel="strain energy (mJ)", xlabel="time (ms)", ylim=(0, 1.3e3 * histories[RHEXIS]["strain_J"][until].max()))
    damage.set(ylabel="largest damage", xlabel="time (ms)", ylim=(0, 1))
    damage.axhline(RUPTURE_DAMAGE, color="black", linewidth=0.6)
    difference.set(ylabel="difference from Rhexis /\nlargest value before rupture")
    for axes in (displacement, difference, energy, damage):
        axes.grid(alpha=0.3)
    displacement.legend(frameon=False, title="vertical lines: onset of rupture")
    difference.legend(frameon=False, fontsize=8)
    figure.savefig(path, dpi=150)


def report(timing, events, differences):
    ms = lambda seconds: "-" if seconds is None else f"{1e3 * seconds:.4f}"
    print(f"Speed: {timing['particles']} particles, {timing['directed_bonds']} directed bonds, {timing['cores']} cores")
    print("| code | steps/s, median | range |\n| --- | --- | --- |")
    for name, rate in timing["steps_per_s"].items():
        print(f"| {name.split()[0]} | {rate['median']:.1f} | {rate['least']:.1f}-{rate['most']:.1f} |")
    ratio = timing["ratio"]
    print(f"| Rhexis / LAMMPS | {ratio['median']:.1f} | {ratio['least']:.1f}-{ratio['most']:.1f} |\n")
    print("| physics | first bond breaks (ms) | damage 0.2 (ms) | mean displacement then (mm) |\n| --- | --- | --- | --- |")
    for name, event in events.items():
        print(f"| {name} | {ms(event['first_break_s'])} | {ms(event['onset_s'])} | {ms(event.get('ring_mean_at_onset_m'))} |")
    print("\n| largest difference from Rhexis | before (ms) | " + " | ".join(COLUMNS.values()) + " |")
    print("| --- | --- |" + " --- |" * len(COLUMNS))
    words = {"first_break_s": "the first break", "onset_s": "rupture"}
    for name, by_event in differences.items():
        for event, values in by_event.items():
            cells = " | ".join(f"{values[key]:.1e}" for key in COLUMNS)
            print(f"| {name} | {words[event]}, {ms(values['until_s'])} | {cells} |")
    print("\n" + DIFFERENCES)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/rhexis", help="Rhexis")
    parser.add_argument("--cores", type=int, default=2, help="threads of Rhexis, ranks of LAMMPS")
    parser.add_argument("--repeat", type=int, default=3, help="timings of each code")
    parser.add_argument("--timing-steps", type=int, default=200, help=f"steps of LAMMPS in a timing; Rhexis takes {RHEXIS_STEPS} times as many")
    parser.add_argument("--length", type=float, default=4.0, help="mm of the vessel that is torn (shorter ones are held by their ends)")
    parser.add_argument("--end", type=float, default=2.4, help="ms until which it is loaded")
    parser.add_argument("--every", type=int, default=20, help="steps between the points of a history")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/peers")
    options = parser.parse_args()
    options.lammps = lammps()
    options.output.mkdir(parents=True, exist_ok=True)
    program = options.program.resolve()

    timing = speed(options, program)
    histories, events = physics(options, program)
    differences = {name: deviations_before_events(histories, events, name) for name in LATTICE}

    (options.output / "peers.json").write_text(json.dumps(
        {"speed": timing, "length_mm": options.length, "events": events, "differences": differences}, indent=2) + "\n")
    with open(options.output / "peers.csv", "w", encoding="utf-8") as file:
        curves = {f"{name.lower().replace(' ', '_')}_{key}": values for name, history in histories.items()
                  for key, values in history.items() if key != "time_s"}
        writer = csv.writer(file)
        writer.writerow(["time_s", *curves])
        writer.writerows(zip(histories[RHEXIS]["time_s"], *curves.values()))
    draw(histories, events, options.output / "peers.png")
    report(timing, events, differences)
    print(f"\n{options.output / 'peers.png'}")


if __name__ == "__main__":
    main()
