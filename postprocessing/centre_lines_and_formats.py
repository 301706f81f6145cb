#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Networks as centre line tools write them, and how long a million vessels take to read in each format.

    postprocessing/centre_lines_and_formats.py [--vessels 1000000] [--only centre_lines | formats] [-o FOLDER]

1. Centre lines as vmtk's: a line from the inlet to every outlet, so that trunks are repeated, with the radii of the largest spheres
   (MaximumInscribedSphereRadius): a Y, and an arch with five outlets. Each is drawn once, repeated, repeated with jitter of 1 um, and
   sampled anew for every line; flows are compared with those of the network drawn once. Then the vessels are screened, and the wall of
   one branch is coupled by its name.
2. A binary tree of about so many vessels as CSV, JSON, GraphML, Secomb's .dat, SWC, VTP and .vtk (and a twentieth as many centre lines
   of twenty segments each): seconds of a processor and memory of `rhexis network FILE`, which reads, looks for slips, and counts parts
   and ends.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys

import numpy
from centre_lines import INLET_PRESSURE, OUTLET_PRESSURE, STYLES, arch_network, lines_of, write_centre_lines, write_vtp, y_network
from places import PROGRAM, RESULTS

SCENE = """
[scene]
model = "{model}"
[network]
source = "file"
files = ["{file}"]
file_length_unit = "mm"
[blood]
viscosity_law = "constant"
"""
SCREENING = """
[screening]
top = 3
"""
COUPLING = """
[coupling]
vessel = "{vessel}"
radius_of = "narrowest"
[material]
critical_stretch = 0.02
[discretisation]
particles = 20000
[load]
ramp_time = "0.1 ms"
[time]
end = "0.1 ms"
"""


# Runs the program that its arguments name, and prints seconds of a processor and the most memory (kB) that it took: in a small process of its
# own, as a new process counts what its parent has in memory.
MEASURE = """
import resource, subprocess, sys
status = subprocess.run(sys.argv[1:]).returncode
usage = resource.getrusage(resource.RUSAGE_CHILDREN)
print(usage.ru_utime + usage.ru_stime, usage.ru_maxrss, flush=True)
sys.exit(status)
"""


def run(folder, name, scene):
    """The record of a run."""
    path = folder / f"{name}.toml"
    path.write_text(scene)
    done = subprocess.run([PROGRAM, "run", path, "-o", folder / name, "--quiet", "--overwrite"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads((folder / name / "run.json").read_text())["results"]


def centre_lines(folder):
    """Flows of every style, then screening and coupling."""
    print("| centre lines | drawn | lines | vessels | inflow, L/min | off |\n| --- | --- | --- | --- | --- | --- |")
    for shape, vessels in (("Y", y_network()), ("arch with five outlets", arch_network())):
        truth = None
        for style in STYLES:
            file = folder / f"{shape[0]}_{style}.vtp"
            lines = lines_of(vessels, style)
            write_centre_lines(file, vessels, lines)
            network = run(folder, f"{shape[0]}_{style}", SCENE.format(model="network", file=file) + SCREENING)["network"]
            truth = truth or network["inflow_m3_s"]
            print(f"| {shape} | {style} | {len(lines)} | {network['vessels']} | {6e4 * network['inflow_m3_s']:.4g} "
                  f"| {abs(network['inflow_m3_s'] / truth - 1):.1e} |")
    print("\nscreening of the arch, repeated lines with jitter:")
    print((folder / "a_jitter" / "screening.csv").read_text())
    for vessel in ("1", "2"):
        results = run(folder, f"coupled_{vessel}", SCENE.format(model="coupled", file=folder / "a_jitter.vtp") + COUPLING.format(vessel=vessel))
        chosen = results["coupling"]["vessel"]
        print(f"coupled with the wall of branch {vessel}: radius {1e3 * chosen['radius_m']:.3g} mm, length {1e3 * chosen['length_m']:.3g} mm, "
              f"net pressures {', '.join(f'{p / 133.322:.2f}' for p in results['coupling']['net_pressure_Pa'])} mmHg")


# -- formats --------------------------------------------------------------------------------------------------------------------------

class Tree:
    """A binary tree that fills a plane as the letter H of letters H does: vessel v joins junction (v + 1) // 2 to junction v + 1, of which
    each has a place and a radius. Lengths (in mm) fall by the square root of 2 from one generation to the next, radii by its cube root."""

    def __init__(self, vessels):
        self.generations = max(2, vessels.bit_length())
        self.vessels = 2**self.generations - 1
        child = numpy.arange(1, self.vessels + 1)
        self.parent = numpy.concatenate([[0], child // 2])  # of junctions; junction 1 is the first vessel's end
        level = numpy.concatenate([[0], numpy.floor(numpy.log2(child)) + 1])
        self.radius = 2.0 * 2 ** (-level / 3)
        self.points = numpy.zeros((self.vessels + 1, 3))
        self.points[0, 2] = -1e3
        for generation in range(1, self.generations):
            first = 2**generation
            step = 1e3 * 2 ** (-generation / 2) * numpy.tile([-1, 1], first // 2)
            self.points[first : 2 * first] = self.points[self.parent[first : 2 * first]]
            self.points[first : 2 * first, generation % 2] += step
        self.is_leaf = numpy.concatenate([[False], 2 * child > self.vessels])

    def pressures(self):
        """At the root and the leaves, Pa; nan elsewhere."""
        pressure = numpy.where(self.is_leaf, OUTLET_PRESSURE, numpy.nan)
        pressure[0] = INLET_PRESSURE
        return pressure


def write_csv(tree, folder):
    rows = zip(tree.points.tolist(), tree.pressures().tolist())
    (folder / "j.csv").write_text("id,x [mm],y [mm],z [mm],pressure [Pa]\n" + "".join(
        f"{i},{x},{y},{z},{'' if p != p else p}\n" for i, ((x, y, z), p) in enumerate(rows)))
    (folder / "v.csv").write_text("id,from,to,radius [mm]\n" + "".join(
        f"{v},{tree.parent[v + 1]},{v + 1},{tree.radius[v + 1]}\n" for v in range(tree.vessels)))
    return [folder / "j.csv", folder / "v.csv"]


def write_json(tree, folder):
    junctions = [{"id": i, "x": x, "y": y, "z": z, **({} if p != p else {"pressure": p})}
                 for i, ((x, y, z), p) in enumerate(zip(tree.points.tolist(), tree.pressures().tolist()))]
    vessels = [{"id": v, "from": int(tree.parent[v + 1]), "to": v + 1, "radius": float(tree.radius[v + 1])} for v in range(tree.vessels)]
    (folder / "n.json").write_text(json.dumps({"units": {"length": "mm", "pressure": "Pa"}, "junctions": junctions, "vessels": vessels}))
    return [folder / "n.json"]


def write_graphml(tree, folder):
    keys = "".join(f'<key id="{name[0]}" for="{of}" attr.name="{name}" attr.type="double"/>\n'
                   for name, of in (("x", "node"), ("y", "node"), ("z", "node"), ("pressure [Pa]", "node"), ("radius", "edge")))
    nodes = "".join(f'<node id="{i}"><data key="x">{x}</data><data key="y">{y}</data><data key="z">{z}</data>'
                    f'{"" if p != p else f"""<data key="p">{p}</data>"""}</node>\n'
                    for i, ((x, y, z), p) in enumerate(zip(tree.points.tolist(), tree.pressures().tolist())))
    edges = "".join(f'<edge source="{tree.parent[v + 1]}" target="{v + 1}"><data key="r">{tree.radius[v + 1]}</data></edge>\n'
                    for v in range(tree.vessels))
    (folder / "n.graphml").write_text('<graphml xmlns="http://graphml.graphdrawing.org/xmlns">\n' + keys
                                      + f'<graph edgedefault="directed">\n{nodes}{edges}</graph></graphml>\n')
    return [folder / "n.graphml"]


def write_swc(tree, folder):
    (folder / "n.swc").write_text("".join(
        f"{i + 1} 0 {x} {y} {z} {r} {-1 if i == 0 else tree.parent[i] + 1}\n"
        for i, ((x, y, z), r) in enumerate(zip(tree.points.tolist(), tree.radius.tolist()))))
    return [folder / "n.swc"]


def write_dat(tree, folder):
    pressure = tree.pressures()
    ends = numpy.flatnonzero(~numpy.isnan(pressure))
    (folder / "n.dat").write_text(
        f"a tree\n1e7 1e6 0 box dimensions in microns\n10 10 10\n30.\n100.\n3\n{tree.vessels} total number of segments\nname type from to diam flow Hd\n"
        + "".join(f"{v + 1} 5 {tree.parent[v + 1] + 1} {v + 2} {2e3 * tree.radius[v + 1]} 0.0 0.4\n" for v in range(tree.vessels))
        + f"{tree.vessels + 1} total number of nodes\nname x y z\n"
        + "".join(f"{i + 1} {1e3 * x} {1e3 * y} {1e3 * z}\n" for i, (x, y, z) in enumerate(tree.points.tolist()))
        + f"{len(ends)} total number of boundary nodes\nnode bctyp press/flow Hd PO2\n"
        + "".join(f"{i + 1} 0 {pressure[i] / 133.322387415} 0.4 40.\n" for i in ends))
    return [folder / "n.dat"]


def lines_of_tree(tree):
    return numpy.column_stack([tree.parent[1:], numpy.arange(1, tree.vessels + 1)]).ravel().astype(numpy.int64)


def write_tree_vtp(tree, folder):
    write_vtp(folder / "n.vtp", tree.points, lines_of_tree(tree), numpy.arange(2, 2 * tree.vessels + 2, 2, dtype=numpy.int64),
              {"pressure_condition": tree.pressures()}, {"radius": tree.radius[1:].copy()})
    return [folder / "n.vtp"]


def write_polylines(tree, folder):
    """A twentieth as many branches, each a curved line of twenty segments with radii that vary."""
    small, n = Tree(tree.vessels // 20), 20
    begin, end = small.points[small.parent[1:]], small.points[1:]
    t = numpy.linspace(0, 1, n + 1)
    points = begin[:, None, :] + (end - begin)[:, None, :] * t[None, :, None]
    points[:, :, 2] += 0.1 * numpy.linalg.norm(end - begin, axis=1)[:, None] * numpy.sin(numpy.pi * t)
    radius = small.radius[1:, None] * (1 + 0.1 * numpy.cos(7 * t))[None, :]
    pressure = numpy.full(points.shape[:2], numpy.nan)
    pressure[0, 0] = INLET_PRESSURE
    pressure[small.is_leaf[1:], n] = OUTLET_PRESSURE
    write_vtp(folder / "centre_lines.vtp", points.reshape(-1, 3), numpy.arange(radius.size, dtype=numpy.int64),
              numpy.arange(n + 1, radius.size + 1, n + 1, dtype=numpy.int64),
              {"MaximumInscribedSphereRadius": radius.ravel(), "pressure_condition": pressure.ravel()}, {})
    return [folder / "centre_lines.vtp"]


def write_vtk(tree, folder):
    pairs = lines_of_tree(tree).reshape(-1, 2)
    cells = numpy.column_stack([numpy.full(len(pairs), 2), pairs])
    with open(folder / "n.vtk", "wb") as file:
        for head, values in ((f"# vtk DataFile Version 3.0\na tree\nBINARY\nDATASET POLYDATA\nPOINTS {len(tree.points)} double\n", tree.points.astype(">f8")),
                             (f"\nLINES {len(cells)} {cells.size}\n", cells.astype(">i4")),
                             (f"\nCELL_DATA {len(cells)}\nSCALARS radius double 1\nLOOKUP_TABLE default\n", tree.radius[1:].astype(">f8")),
                             (f"\nPOINT_DATA {len(tree.points)}\nSCALARS pressure_condition double 1\nLOOKUP_TABLE default\n", tree.pressures().astype(">f8"))):
            file.write(head.encode() + values.tobytes())
    return [folder / "n.vtk"]


def formats(folder, vessels):
    """Seconds and memory to read a tree in each format."""
    tree = Tree(vessels)
    print("| format | vessels | file, MB | seconds of a processor | memory, MB |\n| --- | --- | --- | --- | --- |")
    for name, write in (("CSV", write_csv), ("JSON", write_json), ("GraphML", write_graphml), ("Secomb's .dat", write_dat), ("SWC", write_swc), ("VTP", write_tree_vtp),
                        (".vtk, binary", write_vtk), ("VTP, centre lines of 20 segments", write_polylines)):
        files = write(tree, folder)
        done = subprocess.run([sys.executable, "-c", MEASURE, PROGRAM, "network", *files, "--length-unit", "mm"], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(done.stdout + done.stderr)
        counted = re.search(r"^  vessels +([\d,]+)$", done.stdout, re.MULTILINE).group(1)
        seconds, kilobytes = map(float, done.stdout.splitlines()[-1].split())
        print(f"| {name} | {counted} | {sum(f.stat().st_size for f in files) / 1e6:.0f} | {seconds:.1f} | {kilobytes / 1024:.0f} |", flush=True)
        for file in files:
            file.unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vessels", type=int, default=1_000_000)
    parser.add_argument("--only", choices=("centre_lines", "formats"))
    parser.add_argument("-o", "--output", type=pathlib.Path, default=RESULTS / "centre_lines_and_formats")
    arguments = parser.parse_args()
    folder = arguments.output.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    if arguments.only != "formats":
        centre_lines(folder)
    if arguments.only != "centre_lines":
        formats(folder, arguments.vessels)


if __name__ == "__main__":
    main()
