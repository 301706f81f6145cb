# SPDX-License-Identifier: BSD-3-Clause
"""Writes a synthetic run as the program would: particles.xdmf and .h5, history.csv."""

import sys
from pathlib import Path

import h5py
import numpy


def vessel(length_m=10e-3, spacing=1e-4):
    grid = (numpy.arange(-20, 20) + 0.5) * spacing
    x, y = (part.ravel() for part in numpy.meshgrid(grid, grid, indexing="ij"))
    radius = numpy.hypot(x, y)
    wall = (radius >= 1.5e-3) & (radius <= 2e-3)
    z = (numpy.arange(round(length_m / spacing)) + 0.5) * spacing
    columns, rows = wall.sum(), len(z)
    return numpy.column_stack([numpy.repeat(x[wall], rows), numpy.repeat(y[wall], rows), numpy.tile(z, columns)])


def fields(rest, progress):
    x, y, z = rest.T
    middle, half = 0.5 * z.max(), 0.4 * z.max() * max(progress - 0.3, 1e-6)
    along = (z - middle) / half
    opening = numpy.where(numpy.abs(along) < 1, numpy.exp(-((numpy.arctan2(y, x) / 0.35) ** 2)) * (1 - along**2), 0.0)
    bulge = 4e-4 * progress * numpy.exp(-(((z - middle) / (0.25 * z.max())) ** 2))
    part = 1.4e-3 * progress * opening
    outward = (bulge + 0.5 * part) / numpy.hypot(x, y)
    displacement = numpy.column_stack([outward * x, outward * y + numpy.where(y < 0, -part, part), numpy.zeros_like(z)])
    return {
        "position": rest + displacement,
        "displacement": displacement,
        "velocity": 100 * displacement,
        "force_density": 1e9 * displacement,
        "damage": 0.5 * opening**2,
        "strain_energy_density": 1e4 * opening,
    }


def data_item(name, step, values):
    shape = " ".join(str(size) for size in values.shape)
    return (
        f'<DataItem Dimensions="{shape}" NumberType="Float" Precision="4" Format="HDF">'
        f"particles.h5:/{name}/{step:06d}</DataItem>"
    )


def write(folder, frames=3, length_m=10e-3):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    rest = vessel(length_m)
    grids, history = [], ["step,time_s,pressure_Pa,max_displacement_m,max_damage,broken_bonds,kinetic_J,strain_J,"
                          "external_work_J,rupture_length_m,leak_m3_s,fracture_J,opening_m2"]
    with h5py.File(folder / "particles.h5", "w") as file:
        file["connectivity"] = numpy.arange(len(rest))
        for frame in range(frames):
            progress, step = frame / max(1, frames - 1), 50 * frame
            values = {name: array.astype("f4") for name, array in fields(rest, progress).items()}
            for name, array in values.items():
                file[f"{name}/{step:06d}"] = array
            attributes = "".join(
                f'<Attribute Name="{name}" AttributeType="{"Vector" if array.ndim == 2 else "Scalar"}" Center="Node">'
                f"{data_item(name, step, array)}</Attribute>"
                for name, array in values.items()
                if name != "position"
            )
            grids.append(
                f'<Grid Name="particles" GridType="Uniform"><Time Value="{2.5e-3 * progress}"/>'
                f'<Information Name="step" Value="{step}"/>'
                f'<Topology TopologyType="Polyvertex" NumberOfElements="{len(rest)}">'
                f'<DataItem Dimensions="{len(rest)}" NumberType="Int" Precision="8" Format="HDF">'
                f"particles.h5:/connectivity</DataItem></Topology>"
                f'<Geometry GeometryType="XYZ">{data_item("position", step, values["position"])}</Geometry>'
                f"{attributes}"
                f'<Attribute Name="pressure" AttributeType="Scalar" Center="Grid"><DataItem Dimensions="1" '
                f'NumberType="Float" Precision="8" Format="XML">{238e3 * min(1, 4 * progress)}</DataItem></Attribute></Grid>'
            )
            largest = float(numpy.linalg.norm(values["displacement"], axis=1).max())
            damage = float(values["damage"].max())
            history.append(f"{step},{2.5e-3 * progress},{238e3 * min(1, 4 * progress)},{largest},{damage},"
                           f"{int(1e6 * damage)},{2e-4 * progress**3},{1e-3 * progress},{1.5e-3 * progress},"
                           f"{8e-3 * max(0, progress - 0.3)},,{3e-4 * progress**2},0")
    (folder / "particles.xdmf").write_text(
        '<?xml version="1.0"?>\n<Xdmf Version="3.0"><Domain>'
        '<Grid Name="run" GridType="Collection" CollectionType="Temporal">' + "\n".join(grids) + "</Grid></Domain></Xdmf>\n"
    )
    (folder / "history.csv").write_text("\n".join(history) + "\n")


if __name__ == "__main__":
    write(sys.argv[1], *(kind(text) for kind, text in zip((int, float), sys.argv[2:])))
