#!/usr/bin/python3
"""The verification suite: Rhexis against closed forms, as a report with plots.

    ./quickstart test     # builds what this runs
    postprocessing/verify.py [--build build/release] [-o results/verification] [--skip-rupture]

Writes report.md and PNGs. Ten minutes on two cores, most of it for the rupture pressures.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

import matplotlib

matplotlib.use("Agg")  # no display needed

import matplotlib.pyplot as plt
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
INNER, OUTER, YOUNG, DENSITY = 1.5e-3, 2e-3, 3.5e6, 1300
OURS = ("polar", "calibrated", "nonlocal")
PAPER = ("lattice", "none", "paper")
SCHEMES = [PAPER, ("lattice", "none", "consistent"), ("lattice", "volume", "consistent"), ("lattice", "energy", "consistent"),
           ("polar", "none", "consistent"), ("polar", "volume", "nonlocal"), ("polar", "energy", "nonlocal"),
           ("polar", "calibrated", "consistent"), OURS]


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
    def __init__(self, build, report):
        self.build, self.report = build, report

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


    def onset(self, *overrides, pressure=320e3, ramp=2.4e-3):
        """Pressure (kPa) under which a 3 mm endless vessel with 3 % of scatter begins to rupture, on a ramp."""
        with tempfile.TemporaryDirectory(prefix="rhexis_verify_") as folder:
            command = [self.build / "bin/rhexis", "run", ROOT / "inputs/vented_vessel.toml", "-o", folder, "--quiet"]
            for override in ("insitu.enabled=false", "output.fields=[]", "vessel.length=3 mm", "boundary.ends=axial_periodic",
                             f"load.pressure={pressure!r} Pa", f"load.ramp_time={ramp!r} s", f"time.end={ramp!r} s", *overrides):
                command += ["--set", override]
            subprocess.run(command, check=True)
            onset = json.loads((pathlib.Path(folder) / "run.json").read_text())["results"]["rupture_onset_s"]
        return onset / ramp * pressure / 1e3 if onset else float("nan")

    def rupture(self):
        self.report.section("Onset of rupture", "Pressure at which damage first reaches 0.2, kPa, on a linear ramp to 320 kPa in 2.4 ms: "
                            "3 mm of an endless vessel, critical stretch 0.25 with 3 % of scatter (0.25 mm, the same wall "
                            "everywhere), horizon 3.5 spacings.")
        scheme = lambda s: [f"discretisation.cross_section={s[0]}", f"discretisation.surface_correction={s[1]}", f"load.layer={s[2]}"]
        spacing = lambda across: [f"discretisation.spacing={(OUTER - INNER) / across!r} m"]
        length = "scatter.correlation_length=0.25 mm"
        rows = []
        for name, of in (("ours", OURS), ("the paper's scheme", PAPER)):
            for across in (3, 5, 7, 10):
                rows.append([name, f"{across} across", f"{self.onset(length, *scheme(of), *spacing(across)):.1f}"])
        for name, of in (("ours", OURS), ("the paper's scheme", PAPER)):
            for turn in (0.25, 0.5, 0.75):
                angle = turn * 2 * np.pi / 110
                value = self.onset(length, *scheme(of), *spacing(5), f"discretisation.rotation={angle!r} rad")
                rows.append([name, f"5 across, turned by {turn} columns", f"{value:.1f}"])
        value = self.onset(length, *scheme(PAPER), *spacing(5), "discretisation.lattice_shift=[0.0, 0.0]")
        rows.append(["the paper's scheme", "5 across, shifted by half a spacing", f"{value:.1f}"])
        for seed in (2, 3):
            rows.append(["ours", f"5 across, wall {seed}", f"{self.onset(length, *scheme(OURS), *spacing(5), f'scatter.seed={seed}'):.1f}"])
        for ramp in (1.2e-3, 4.8e-3, 9.6e-3):
            rows.append(["ours", f"5 across, ramp {ramp * 1e3:g} ms", f"{self.onset(length, *spacing(5), ramp=ramp):.1f}"])
        for stretch in (0.05, 0.1):
            pressure = 320e3 * stretch / 0.25
            value = self.onset(length, *spacing(5), f"material.critical_stretch={stretch}", pressure=pressure)
            rows.append(["ours", f"5 across, critical stretch {stretch}", f"{value:.1f}"])
        for across in (5, 7, 10):
            value = self.onset(length, *spacing(across), "material.energy_release_rate=92 J/m2", pressure=480e3)
            rows.append(["ours", f"{across} across, energy release rate 92 J/m2, ramp to 480 kPa", f"{value:.1f}"])
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
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    report = Report(options.output)
    suite = Suite(options.build.resolve(), report)
    for study in (suite.corrections, suite.refinement, suite.energies, suite.breathing, suite.dispersion, suite.time_step,
                  suite.expansion, *([] if options.skip_rupture else [suite.rupture])):
        study()
        report.write()  # so that what is done is there if the rest fails
    print(options.output / "report.md")


if __name__ == "__main__":
    main()
