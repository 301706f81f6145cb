# SPDX-License-Identifier: BSD-3-Clause
"""The vessel of a Rhexis run as LAMMPS peri/pmb takes it: data file, input, run, results. For compare_peers.py.

LAMMPS' PMB (Parks et al. 2008) works with densities: a particle's mass is its density, a force is a force per volume,
and c is that of Eq. (4); only energies have to be multiplied by a particle's volume.
"""

import dataclasses
import os
import pathlib
import re
import subprocess

import numpy as np

FREE, LOADED, HELD = 1, 2, 3  # types of particles: neither, in the pressure layer, in the clamped ends


@dataclasses.dataclass
class Wall:
    """A lattice wall, its PMB material, its ramp of pressure in the paper's layer, its clamped ends; SI units."""

    positions: np.ndarray
    spacing: float
    horizon: float
    density: float
    bond_constant: float
    critical_stretch: float
    inner_radius: float
    layer_thickness: float
    end_length: float
    pressure_rate: float
    time_step: float

    @property
    def volume(self):
        return self.spacing**3

    def ring(self):
        """Which particles make up the row in the middle."""
        rows = np.unique(self.positions[:, 2].round(9))
        return np.abs(self.positions[:, 2] - rows[len(rows) // 2]) < 0.25 * self.spacing

    def types(self):
        along = self.positions[:, 2] - self.positions[:, 2].min()
        row = np.rint(along / self.spacing)
        held_rows = np.ceil(self.end_length / self.spacing - 1e-9)
        held = (row < held_rows) | (row > row.max() - held_rows)
        depth = np.hypot(self.positions[:, 0], self.positions[:, 1]) - self.inner_radius
        slack = 1e-9 * self.spacing
        loaded = (depth >= -slack) & (depth <= self.layer_thickness + slack)
        return np.where(held, HELD, np.where(loaded, LOADED, FREE))


def wall_of(record, positions):
    """The wall that `record`, the run.json of a run, describes."""
    value = lambda section, key: record["input"][section][key]["value"]
    horizon = value("discretisation", "horizon")
    return Wall(
        positions=positions,
        spacing=value("discretisation", "spacing"),
        horizon=horizon,
        density=value("material", "density"),
        bond_constant=12 * value("material", "young_modulus") / (np.pi * horizon**4),  # Eq. (4), Poisson's ratio 1/4
        critical_stretch=value("material", "critical_stretch"),
        inner_radius=value("vessel", "inner_radius"),
        layer_thickness=value("load", "layer_thickness") or horizon,
        end_length=value("boundary", "end_length") or horizon,
        pressure_rate=value("load", "pressure") / value("load", "ramp_time"),
        time_step=record["results"]["time_step_s"],
    )


def data_text(wall):
    """LAMMPS data file: id, type, volume, density, x, y, z."""
    low, high = wall.positions.min(0) - wall.spacing, wall.positions.max(0) + wall.spacing
    lines = ["vessel", "", f"{len(wall.positions)} atoms", f"{HELD} atom types", ""]
    lines += [f"{low[k]:.9g} {high[k]:.9g} {axis}lo {axis}hi" for k, axis in enumerate("xyz")] + ["", "Atoms # peri", ""]
    for i, (kind, (x, y, z)) in enumerate(zip(wall.types(), wall.positions), start=1):
        lines.append(f"{i} {kind} {wall.volume:.16g} {wall.density:.16g} {x:.17g} {y:.17g} {z:.17g}")
    return "\n".join(lines) + "\n"


def input_text(wall, steps, lattice, every=None):
    """LAMMPS input of `steps` steps; with `every` the histories that read_history reads.

    `lattice` is LAMMPS' lattice constant: bonds within half of it of the horizon get less weight, and particles repel
    each other within 1.35 of it. A tiny one switches both off.
    """
    skin = 0.5 * wall.spacing
    # Ghosts must reach as far as an unbroken bond: LAMMPS silently drops a bond whose partner is out of sight.
    sight = wall.horizon * (1 + wall.critical_stretch) + 2 * skin
    pull = f"{wall.pressure_rate / wall.layer_thickness!r}*step*{wall.time_step!r}"
    text = f"""\
units           si
boundary        s s s
atom_style      peri
atom_modify     map array
neighbor        {skin!r} bin
neigh_modify    every 1 delay 0 check yes
comm_modify     cutoff {sight!r}
lattice         sc {lattice!r}
read_data       wall.data
pair_style      peri/pmb
pair_coeff      * * {wall.bond_constant!r} {wall.horizon!r} {wall.critical_stretch!r} 0
timestep        {wall.time_step!r}

group           loaded type {LOADED}
group           held type {HELD}
fix             reference all store/state 0 x y
variable        radius atom sqrt(f_reference[1]^2+f_reference[2]^2)
variable        bx atom {pull}*f_reference[1]/v_radius
variable        by atom {pull}*f_reference[2]/v_radius
fix             motion all nve
fix             load loaded addforce v_bx v_by 0
fix             ends held setforce 0 0 0
"""
    if every:
        ring = wall.positions[wall.ring(), 2]
        low, high = ring.min() - 0.25 * wall.spacing, ring.max() + 0.25 * wall.spacing
        text += f"""
region          middle block INF INF INF INF {low!r} {high!r} units box
group           ring region middle
compute         damage all damage/atom
compute         worst all reduce max c_damage
fix             damage all ave/time 1 1 1 c_worst file damage.txt
thermo_style    custom step ke pe
thermo_modify   norm no format float %.12g
thermo          {every}
dump            ring ring custom {every} ring.dump id x y
dump_modify     ring sort id format float %.12g
"""
    else:
        text += f"thermo {steps}\n"
    return text + f"run {steps}\n"


def run(program, folder, wall, steps, lattice, cores, every=None):
    """Runs LAMMPS in `folder`; returns (seconds of its time loop, directed bonds)."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "wall.data").write_text(data_text(wall))
    (folder / "in.vessel").write_text(input_text(wall, steps, lattice, every))
    launcher = ["mpirun", "--bind-to", "none", "--oversubscribe", "-n", str(cores)] if cores > 1 else []
    as_root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    done = subprocess.run([*launcher, program, "-in", "in.vessel", "-log", "log.lammps", "-screen", "none"], cwd=folder,
                          env={**os.environ, **as_root, "OMP_NUM_THREADS": "1"}, capture_output=True, text=True)
    log = (folder / "log.lammps").read_text() if (folder / "log.lammps").exists() else ""
    loop = re.search(r"Loop time of (\S+) on", log)
    if done.returncode or not loop:
        raise RuntimeError(f"LAMMPS failed, see {folder / 'log.lammps'}: {(done.stderr or log)[-400:].strip()}")
    return float(loop[1]), int(re.search(r"total # of bonds = (\d+)", log)[1])


def read_history(folder, wall):
    """(columns by name at every output, largest damage at every step) of a run with histories."""
    folder = pathlib.Path(folder)
    log = (folder / "log.lammps").read_text()
    table = re.search(r"^Step\b.*?\n(.*?)^Loop time", log, re.MULTILINE | re.DOTALL)[1]
    step, kinetic, strain = np.array([line.split() for line in table.splitlines()
                                      if re.match(r"\s*\d+(\s+\S+){2}\s*$", line)], dtype=float).T
    blocks = re.split(r"^ITEM: TIMESTEP\n", (folder / "ring.dump").read_text(), flags=re.MULTILINE)[1:]
    particles = [re.split(r"^ITEM: ATOMS.*\n", block, flags=re.MULTILINE)[1].splitlines() for block in blocks]
    xy = np.array([[line.split()[1:] for line in lines] for lines in particles], dtype=float)
    reference = wall.positions[wall.ring(), :2]
    damage = np.loadtxt(folder / "damage.txt")[:, 1]
    damage[0] = 0  # LAMMPS says 1: it counts families only after it has told the damage at step 0
    columns = {"time_s": step * wall.time_step, **ring_columns(xy - reference, reference),
               "kinetic_J": kinetic * wall.volume, "strain_J": strain * wall.volume, "max_damage": damage[step.astype(int)]}
    return columns, damage


def ring_columns(displacements, reference):
    """Mean and largest radial displacement of the ring at each moment."""
    radial = (displacements * reference).sum(-1) / np.hypot(*reference.T)
    return {"ring_mean_m": radial.mean(1), "ring_max_m": radial.max(1)}
