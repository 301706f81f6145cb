#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The verification suite: Rhexis against closed forms, as a report with plots.

    ./quickstart test     # builds what this runs
    postprocessing/verify.py [--build build/release] [-o results/verification] [--skip-rupture] [--only STUDY...]

Writes report.md and PNGs. On two busy cores some quarter of an hour, and another twenty for the rupture pressures.
"""

import argparse
import pathlib
import subprocess

import matplotlib

matplotlib.use("Agg")  # no display needed

import matplotlib.pyplot as plt
import numpy as np

from onset import OURS, PAPER, ROOT, onset, run, settings

INNER, OUTER, YOUNG, DENSITY = 1.5e-3, 2e-3, 3.5e6, 1300
SCHEMES = [PAPER, ("lattice", "none", "consistent"), ("lattice", "volume", "consistent"), ("lattice", "energy", "consistent"),
           ("polar", "none", "consistent"), ("polar", "volume", "nonlocal"), ("polar", "energy", "nonlocal"),
           ("polar", "calibrated", "consistent"), OURS]
STUDIES = ("corrections", "refinement", "energies", "breathing", "drift", "dispersion", "time_step", "free_ends", "expansion",
           "crack_speed", "rupture")


class Report:
    """Markdown, section by section, and the plots beside it."""

    def __init__(self, folder):
        self.folder = folder
        self.lines = ["# Verification", ""]

    def section(self, title, text):
        print(title, flush=True)
        self.lines += [f"## {title}", "", text, ""]

    def table(self, header, rows):
        self.lines += ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
        self.lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows] + [""]

    def plot(self, name, curves, xlabel, ylabel, logarithmic=True):
        figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
        for label, (x, y, style) in curves.items():
            (axes.loglog if logarithmic else axes.plot)(x, y, style, label=label)
        axes.set(xlabel=xlabel, ylabel=ylabel)
        axes.grid(True, which="both", alpha=0.3)
        axes.legend()
        figure.savefig(self.folder / f"{name}.png", dpi=150)
        plt.close(figure)
        self.lines += [f"![{name}]({name}.png)", ""]

    def write(self):
        (self.folder / "report.md").write_text("\n".join(self.lines))


class Suite:
    def __init__(self, build, report, drift_steps):
        self.build, self.report, self.drift_steps = build, report, drift_steps

    def study(self, *arguments):
        """Rows of one study of build/.../bin/verification, as dictionaries of numbers and words."""
        output = subprocess.run([self.build / "bin/verification", *map(str, arguments)], capture_output=True, text=True, check=True)
        header, *rows = [line.split(",") for line in output.stdout.split()]
        as_number = lambda word: float(word) if word[-1].isdigit() else word
        return [dict(zip(header, map(as_number, row))) for row in rows]

    def elasticity(self, scheme, across, ratio=3.5):
        return self.study("elasticity", *scheme, across, ratio)[0]

    def corrections(self):
        self.report.section("Surface corrections", "Static expansion in plane strain against Lame's solution: relative L2 error of the radial "
                            "displacement, and how far its ratio to the exact one varies over the wall.")
        rows = []
        for scheme in SCHEMES:
            cells = list(scheme)
            for across in (5, 10):
                row = self.elasticity(scheme, across)
                cells += [f"{100 * row['error']:.2f} %", f"{100 * row['spread']:.1f} %"]
            rows.append(cells)
        self.report.table(["cross-section", "correction", "layer", "5 across: error", "spread", "10 across: error", "spread"], rows)

    def refinement(self):
        self.report.section("Refinement", "The same error: horizon and spacing refined together (delta), the horizon held at 350 um while the "
                            "spacing falls (m), and the horizon shrinking more slowly than the spacing (both).")
        wall = OUTER - INNER
        curves = {}
        for label, scheme, style in (("ours, horizon 3.5 spacings", OURS, "o-"), ("the paper's, 3.5 spacings", PAPER, "s--")):
            across = [3, 4, 5, 7, 10, 14, 20]
            curves[label] = (wall / np.array(across) * 1e6, [100 * self.elasticity(scheme, n)["error"] for n in across], style)
        ratios = np.array([2.5, 3, 3.5, 4, 5, 6, 7])
        curves["ours, horizon 350 um"] = (350 / ratios, [100 * self.elasticity(OURS, wall / 350e-6 * m, m)["error"] for m in ratios], "^-")
        across = np.array([3, 5, 7, 10, 14, 20])
        curves["ours, horizon as root of spacing"] = (wall / across * 1e6, [100 * self.elasticity(OURS, n, 3.5 * (n / 5) ** 0.5)["error"] for n in across], "v-")
        self.report.plot("refinement", curves, "spacing (um)", "error against Lame (%)")
        self.report.table(["series", *[f"{i + 1}" for i in range(7)]],
                          [[label, *[f"{x:.0f} um: {y:.2f} %" for x, y in zip(xs, ys)]] for label, (xs, ys, _) in curves.items()])

    def energies(self):
        self.report.section("Homogeneous strains", "Elastic energy of the wall under axial stretch, torsion and equal strain on all sides, "
                            "relative to the exact one: of the whole wall, and the extremes over its columns.")
        rows = []
        for scheme in (PAPER, OURS):
            for row in self.study("energy", *scheme, 5, 3.5):
                rows.append([" ".join(scheme), row["strain"], *[f"{100 * row[key]:+.2f} %" for key in ("wall", "least", "most")]])
        self.report.table(["scheme", "strain", "wall", "least", "most"], rows)

    def breathing(self):
        self.report.section("Breathing", "Frequency of the gravest axisymmetric vibration, against the root of the tube's equation "
                            "(Bessel functions, both surfaces free).")
        rows = []
        for scheme, across in ((PAPER, 5), (PAPER, 10), (OURS, 5), (OURS, 7)):
            row = self.study("breathing", *scheme, across, 3.5)[0]
            rows.append([" ".join(scheme), across, f"{row['exact_Hz']:.0f}", f"{row['measured_Hz']:.0f}", f"{100 * row['error']:+.2f} %"])
        self.report.table(["scheme", "across", "exact (Hz)", "measured (Hz)", "error"], rows)

    def dispersion(self):
        self.report.section("Dispersion", "Plane longitudinal waves along the axis, in the bulk: phase speed over that of long waves, from "
                            "the forces on particles and from the integral over a spherical horizon.")
        curves = {}
        for ratio in (3.5, 6):
            rows = self.study("dispersion", ratio)
            x = [row["spacings_per_wavelength"] / ratio for row in rows]
            curves[f"{ratio} spacings a horizon"] = (x, [row["measured"] for row in rows], "o")
            if ratio == 6:
                curves["PMB continuum"] = (x, [row["exact"] for row in rows], "-")
        self.report.plot("dispersion", curves, "wavelength / horizon", "phase speed / that of long waves")

    def time_step(self):
        self.report.section("Time step", "Displacements after a quarter of a breath against a step of 1/64 of the stable one, relative to "
                            "those at the start; second order.")
        fractions = np.array([0.8, 0.4, 0.2, 0.1, 0.05])
        errors = np.array([self.study("time_step", *OURS, 3, 3.5, f)[0]["error"] for f in fractions])
        self.report.plot("time_step", {"measured": (fractions, errors, "o-"),
                                       "second order": (fractions, errors[-1] * (fractions / fractions[-1]) ** 2, "k:")},
                         "step / stable step", "error")
        single = self.study("precision", *OURS, 5, 3.5)[0]["difference"]
        self.report.lines += [f"Bonds in single precision differ from double by {single:.1e} in the same run (spacing 100 um, step 0.8).", ""]

    def expansion(self):
        self.report.section("Finite strain", "Mean radial displacement of the innermost ring at rest under a dead pressure, against the "
                            "hyperelastic tube whose energy is that of PMB bonds in a homogeneous strain (small horizon).")
        rows = []
        for pressure in (1e3, 50e3, 100e3, 150e3, 200e3):
            exact = hyperelastic_tube(pressure)
            for across in (5, 10) if pressure == 200e3 else (5,):
                ring = self.study("expansion", *OURS, across, 3.5, pressure)[0]
                u = np.interp(ring["r_m"], *exact)
                rows.append([f"{pressure / 1e3:.0f}", across, f"{1e6 * u:.2f}", f"{1e6 * ring['displacement_m']:.2f}",
                             f"{100 * (ring['displacement_m'] / u - 1):+.2f} %"])
        self.report.table(["pressure (kPa)", "across", "exact (um)", "measured (um)", "error"], rows)

    def drift(self):
        self.report.section("Energy drift", f"The unloaded tube, 3 spacings across the wall, breathes undamped for {self.drift_steps:,} steps of 0.65 "
                            "of the stable one (the default): leapfrog's own (shadow) Hamiltonian, means over tenths of the run relative to the first. Trend: a "
                            "line through all ten, with its standard error.")
        rows = []
        for amplitude in (1e-3, 1e-2):
            found = self.study("drift", *OURS, 3, 3.5, amplitude, self.drift_steps)
            steps, drift = (np.array([row[key] for row in found]) for key in ("step", "drift"))
            line, covariance = np.polyfit(steps / 1e6, drift, 1, cov=True)
            rows.append([f"{amplitude:g}", f"{np.abs(drift).max():.1e}", f"{line[0]:+.1e} +- {covariance[0, 0] ** 0.5:.0e}"])
        self.report.table(["strains", "largest of the ten", "trend per 1e6 steps"], rows)

    def free_ends(self):
        self.report.section("Free ends", "A vessel 8 mm long with free ends at rest under a small pressure, at mid-length, against Lame's tube "
                            "without axial force: relative L2 error of the radial displacement, and the axial strain over the exact one less 1.")
        rows = []
        for scheme in (PAPER, OURS):
            for across in (5, 10):
                row = self.study("free_ends", *scheme, across, 3.5, round(8e-3 / (OUTER - INNER) * across))[0]
                rows.append([" ".join(scheme), across, f"{100 * row['displacement']:.2f} %", f"{100 * row['axial_strain']:+.1f} %"])
        self.report.table(["scheme", "across", "radial displacement", "axial strain"], rows)

    def crack_speed(self):
        length, weak = 20e-3, 1e-3
        self.report.section("Crack speed", "A clamped vessel of 20 mm, 3 % of scatter, a weak spot in the middle (radius 1 mm, critical stretch down to "
                            "5 %), dead pressure on a ramp to 300 kPa in 2.4 ms. A crack runs from the spot to both ends. Speed of a tip: half "
                            "the growth rate of the length over which damage is 0.2 somewhere, while it is 4 to 18 mm, against that of "
                            "Rayleigh waves. Where the crack has branched it is the axial speed of the foremost branches; above Rayleigh's, the "
                            "wall would have to tear elsewhere too.")
        # (2 - x)^2 = 4 sqrt(1 - x) sqrt(1 - x / 3) for nu = 1/4, x = (speed / that of shear waves)^2; squared, over x.
        root = min(root.real for root in np.roots([1, -8, 24 - 16 / 3, -16 + 16 / 3]) if abs(root.imag) < 1e-9)
        rayleigh = np.sqrt(root * YOUNG / 2.5 / DENSITY)
        spot = f'\n[[spot]]\nposition = "{length / 2!r} m"\nangle = "22 deg"\nradius = "{weak!r} m"\ncritical_stretch = 0.05\n'
        rows, curves = [], {}
        for across, seed in ((5, 1), (5, 2), (5, 3), (7, 1)):
            spacing = (OUTER - INNER) / across
            _, history = run(self.build, f"vessel.length={length!r} m", f"discretisation.spacing={spacing!r} m", f"scatter.seed={seed}",
                             "load.pressure=300 kPa", "load.direction=dead", "load.venting=none", "time.end=1.4 ms", "output.every_time=10 us", addition=spot)
            time, ruptured = history["time_s"], history["rupture_length_m"]
            grows = (ruptured >= 4 * weak) & (ruptured <= length - 2 * weak)
            t, x = time[grows], ruptured[grows]
            slope, start = np.polyfit(t, x, 1)
            off = np.sqrt(np.mean((x - slope * t - start) ** 2))
            fastest = ((x[5:] - x[:-5]) / (t[5:] - t[:-5])).max() / 2
            rows.append([across, seed, f"{1e3 * x[0]:.1f} to {1e3 * x[-1]:.1f} mm from {1e3 * t[0]:.2f} to {1e3 * t[-1]:.2f} ms",
                         f"{1e3 * off:.2f} mm" + (": no line" if off > 3 * spacing else ""), f"{slope / 2:.1f}", f"{slope / 2 / rayleigh:.2f}",
                         f"{fastest:.1f} +- {spacing / 50e-6 / 2:.1f}", f"{fastest / rayleigh:.2f}"])
            if seed == 1:
                shown = time > t[0] - 0.2e-3
                curves[f"{across} spacings across the wall"] = (1e3 * (time - t[0])[shown], 1e3 * ruptured[shown], ".-")
        curves["both tips at Rayleigh's speed"] = (1e3 * (x - x[0]) / (2 * rayleigh), 1e3 * x, "k--")
        self.report.table(["across", "wall", "growth", "off a line (rms)", "speed (m/s)", "over Rayleigh's", "fastest in 50 us (m/s)",
                           "over Rayleigh's"], rows)
        self.report.lines += [f"Rayleigh waves: {rayleigh:.2f} m/s; +-: one spacing of length.", ""]
        self.report.plot("crack_speed", curves, "time since it was 4 mm long (ms)", "ruptured length (mm)", logarithmic=False)

    def rupture(self):
        self.report.section("Onset of rupture", "Pressure at which damage first reaches 0.2, kPa, on a linear ramp to 320 kPa in 2.4 ms: "
                            "3 mm of an endless vessel, critical stretch 0.25 with 3 % of scatter (0.25 mm, the same wall "
                            "everywhere), horizon 3.5 spacings. A blood pressure for ours, on the undeformed lumen for the paper's scheme.")
        kilopascals = lambda *overrides, **ramp: f"{onset(self.build, *overrides, **ramp)['kPa']:.1f}"
        spacing = lambda across: [f"discretisation.spacing={(OUTER - INNER) / across!r} m"]
        rows = []
        for name, of in (("ours", OURS), ("the paper's scheme", PAPER)):
            for across in (3, 5, 7, 10):
                rows.append([name, f"{across} across", kilopascals(*settings(of), *spacing(across))])
        for across in (5, 7, 10):
            value = kilopascals(*spacing(across), "discretisation.horizon=350 um", "vessel.length=1.5 mm")
            rows.append(["ours", f"{across} across, horizon 350 um, 1.5 mm", value])
        for name, of in (("ours", OURS), ("the paper's scheme", PAPER)):
            for turn in (0.25, 0.5, 0.75):
                angle = turn * 2 * np.pi / 110
                value = kilopascals(*settings(of), *spacing(5), f"discretisation.rotation={angle!r} rad")
                rows.append([name, f"5 across, turned by {turn} columns", value])
        value = kilopascals(*settings(PAPER), *spacing(5), "discretisation.lattice_shift=[0.0, 0.0]")
        rows.append(["the paper's scheme", "5 across, shifted by half a spacing", value])
        for seed in (2, 3):
            rows.append(["ours", f"5 across, wall {seed}", kilopascals(*settings(OURS), *spacing(5), f"scatter.seed={seed}")])
        for ramp in (1.2e-3, 4.8e-3, 9.6e-3):
            rows.append(["ours", f"5 across, ramp {ramp * 1e3:g} ms", kilopascals(*spacing(5), ramp=ramp)])
        for stretch in (0.05, 0.1):
            pressure = 320e3 * stretch / 0.25
            value = kilopascals(*spacing(5), f"material.critical_stretch={stretch}", pressure=pressure)
            rows.append(["ours", f"5 across, critical stretch {stretch}", value])
        for across in (5, 7, 10):
            value = kilopascals(*spacing(across), "material.energy_release_rate=92 J/m2", pressure=480e3)
            rows.append(["ours", f"{across} across, energy release rate 92 J/m2, ramp to 480 kPa", value])
        self.report.table(["scheme", "what", "onset (kPa)"], rows)


def hyperelastic_tube(pressure, elements=60):
    """(r, u) of a tube in plane strain, W = 3 E / (4 pi) integral over directions n of (|F n| - 1)^2 / 1, dead pressure."""
    cosines, weights = np.polynomial.legendre.leggauss(24)
    angles = np.pi / 32 * (np.arange(32) + 0.5) / 2
    m, phi = np.meshgrid(cosines, angles)
    w = np.broadcast_to(weights, m.shape) * 2 * np.pi / 32
    n2 = np.array([(1 - m**2) * np.cos(phi) ** 2, (1 - m**2) * np.sin(phi) ** 2, m**2])

    def stress(radial, hoop):
        """dW/d(radial stretch), dW/d(hoop stretch) at each element."""
        length = np.sqrt(radial[:, None, None] ** 2 * n2[0] + hoop[:, None, None] ** 2 * n2[1] + n2[2])
        pull = 3 * YOUNG / (4 * np.pi) * 2 * (length - 1) / length * w
        return radial * (pull * n2[0]).sum((1, 2)), hoop * (pull * n2[1]).sum((1, 2))

    nodes = np.linspace(INNER, OUTER, elements + 1)
    step, middle = np.diff(nodes), 0.5 * (nodes[1:] + nodes[:-1])

    def out_of_balance(r):
        along, around = stress(np.diff(r) / step, 0.5 * (r[1:] + r[:-1]) / middle)
        force = np.zeros_like(r)
        force[:-1] += -along * middle + around * step / 2
        force[1:] += along * middle + around * step / 2
        force[0] -= load * INNER
        return force

    r = nodes.copy()
    for load in pressure * np.linspace(0.1, 1, 10):
        for _ in range(20):
            force = out_of_balance(r)
            if np.abs(force).max() < 1e-9 * load * INNER:
                break
            nudge = 1e-9
            slope = np.array([(out_of_balance(r + nudge * e) - force) / nudge for e in np.eye(len(r))]).T
            r = r - np.linalg.solve(slope, force)
    return nodes, r - nodes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/verification")
    parser.add_argument("--skip-rupture", action="store_true")
    parser.add_argument("--only", nargs="+", choices=STUDIES, default=STUDIES, metavar="STUDY", help=", ".join(STUDIES))
    parser.add_argument("--drift-steps", type=int, default=100_000)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    report = Report(options.output)
    suite = Suite(options.build.resolve(), report, options.drift_steps)
    for study in STUDIES:
        if study not in options.only or (study == "rupture" and options.skip_rupture):
            continue
        getattr(suite, study)()
        report.write()  # so that what is done is there if the rest fails
    print(options.output / "report.md")


if __name__ == "__main__":
    main()
