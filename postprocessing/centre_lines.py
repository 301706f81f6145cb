# SPDX-License-Identifier: BSD-3-Clause
"""Centre lines as tools like vmtk write them, from curves: a line from the inlet to every outlet, which repeats the trunk, with the radii
of the largest spheres inside (MaximumInscribedSphereRadius). Lengths are in mm, pressures in Pa."""

import base64

import numpy

INLET_PRESSURE, OUTLET_PRESSURE = 13332.2, 13318.9  # 100 and 99.9 mmHg
STYLES = ("once", "repeated", "jitter", "resampled")


def data_array(name, values, components=1):
    """An array of a VTP file, in base64."""
    kind = "Int64" if values.dtype == numpy.int64 else "Float64"
    data = values.tobytes()
    text = base64.b64encode(len(data).to_bytes(8, "little") + data).decode()
    return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="binary">{text}</DataArray>\n'


def write_vtp(path, points, connectivity, offsets, point_arrays, cell_arrays):
    """Polylines with numpy arrays: points [P, 3], connectivity and offsets as VTK has them, arrays by name."""
    path.write_text(
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"><PolyData>\n'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfVerts="0" NumberOfLines="{len(offsets)}" NumberOfStrips="0" NumberOfPolys="0">\n'
        f'<PointData>{"".join(data_array(n, v) for n, v in point_arrays.items())}</PointData>\n'
        f'<CellData>{"".join(data_array(n, v) for n, v in cell_arrays.items())}</CellData>\n'
        f'<Points>{data_array("Points", points, 3)}</Points>\n'
        f'<Lines>{data_array("connectivity", connectivity)}{data_array("offsets", offsets)}</Lines></Piece></PolyData></VTKFile>\n')


def curve(corners, radii):
    """A smooth curve in mm through corners (Catmull-Rom) with radii in mm: a function of 0 .. 1 to x, y, z, radius."""
    knots = numpy.column_stack([numpy.array(corners, float), numpy.array(radii, float)])
    ends = numpy.vstack([2 * knots[0] - knots[1], knots, 2 * knots[-1] - knots[-2]])

    def at(t):
        s = numpy.clip(numpy.asarray(t) * (len(knots) - 1), 0, len(knots) - 1)
        i = numpy.minimum(s.astype(int), len(knots) - 2)
        u = (s - i)[:, None]
        a, b, c, d = (ends[i + k] for k in range(4))
        return 0.5 * (2 * b + (c - a) * u + (2 * a - 5 * b + 4 * c - d) * u**2 + (3 * b - a - 3 * c + d) * u**3)
    return at


def y_network():
    """Trunk and branches of a Y: each a curve and where on its parent it begins."""
    return {"trunk": (curve([(0, 0, 0), (1, 0, 10), (0, 0, 20)], [3, 2.8, 2.6]), None, 0),
            "left": (curve([(0, 0, 20), (-3, 1, 25), (-8, 1, 32)], [2.2, 2.0, 1.9]), "trunk", 1),
            "right": (curve([(0, 0, 20), (4, -1, 24), (9, 0, 31)], [2.1, 1.8, 1.7]), "trunk", 1)}


def arch_network():
    """An arch like the aorta's, from which three vessels leave before its end and one divides: five outlets."""
    arch = curve([(0, 0, 0), (0, 0, 40), (12, 4, 62), (32, 8, 66), (50, 8, 50), (54, 6, 10), (54, 4, -60)],
                 [14, 13.5, 13, 12, 11.5, 11, 10])
    vessels = {"arch": (arch, None, 0)}
    for name, share, rise, radius in (("brachiocephalic", 0.42, 35, 6), ("carotid", 0.5, 50, 3.5), ("subclavian", 0.58, 45, 4.5)):
        x, y, z, _ = arch(numpy.array([share]))[0]
        vessels[name] = (curve([(x, y, z), (x + 3, y, z + rise / 2), (x + 4, y + 6, z + rise)], [radius, 0.95 * radius, 0.9 * radius]), "arch", share)
    x, y, z, _ = vessels["brachiocephalic"][0](numpy.array([1.0]))[0]
    vessels["right carotid"] = (curve([(x, y, z), (x - 4, y, z + 25), (x - 5, y, z + 50)], [3.6, 3.4, 3.3]), "brachiocephalic", 1)
    vessels["right subclavian"] = (curve([(x, y, z), (x - 15, y, z + 8), (x - 30, y, z + 8)], [4.4, 4.2, 4.0]), "brachiocephalic", 1)
    return vessels


def sampled(vessels, name, begin, end, step):
    """Rows x, y, z, radius of a vessel between two shares of it, about `step` mm apart; it begins with its parent's radius."""
    fine = vessels[name][0](numpy.linspace(begin, end, 200))
    length = numpy.linalg.norm(numpy.diff(fine[:, :3], axis=0), axis=1).sum()
    rows = vessels[name][0](numpy.linspace(begin, end, max(2, round(length / step) + 1)))
    _, parent, share = vessels[name]
    if begin == 0 and parent is not None:
        rows[0, 3] = vessels[parent][0](numpy.array([share]))[0, 3]
    return rows


def stretches(vessels, name):
    """The shares at which other vessels leave one, from 0 to 1."""
    return sorted({0.0, 1.0, *(share for _, parent, share in vessels.values() if parent == name)})


def way_to(vessels, name):
    """The stretches (vessel, from, to) from the inlet to the end of a vessel."""
    steps, end = [], 1.0
    while name is not None:
        cuts = [s for s in stretches(vessels, name) if s <= end]
        steps = [(name, a, b) for a, b in zip(cuts, cuts[1:])] + steps
        _, name, end = vessels[name]
    return steps


def is_outlet(vessels, name):
    """Whether nothing leaves the end of a vessel."""
    return not any(parent == name and share == 1 for _, parent, share in vessels.values())


def lines_of(vessels, style, step=1.0):
    """The lines of a style: "once" (each stretch once), "repeated", "jitter" (of 1 um), "resampled" (each line with a step of its own)."""
    if style == "once":
        return [sampled(vessels, name, a, b, step) for name in vessels for a, b in zip(stretches(vessels, name), stretches(vessels, name)[1:])]
    random, lines = numpy.random.default_rng(1), []
    for number, name in enumerate(n for n in vessels if is_outlet(vessels, n)):
        own_step = step * (1 + 0.13 * number) if style == "resampled" else step
        pieces = [sampled(vessels, *stretch, own_step) for stretch in way_to(vessels, name)]
        line = numpy.vstack([pieces[0], *(piece[1:] for piece in pieces[1:])])
        if style == "jitter":
            line[1:, :3] += random.uniform(-1e-3, 1e-3, line[1:, :3].shape)
        lines.append(line)
    return lines


def write_centre_lines(path, vessels, lines):
    """A VTP file with a pressure at the inlet and at every outlet."""
    rows = numpy.vstack(lines)
    offsets = numpy.cumsum([len(line) for line in lines]).astype(numpy.int64)
    pressure = numpy.full(len(rows), numpy.nan)
    inlet = next(iter(vessels.values()))[0](numpy.array([0.0]))[0, :3]
    outlets = numpy.vstack([v[0](numpy.array([1.0]))[0, :3] for name, v in vessels.items() if is_outlet(vessels, name)])
    pressure[numpy.linalg.norm(rows[:, :3] - inlet, axis=1) < 0.01] = INLET_PRESSURE
    for outlet in outlets:
        pressure[numpy.linalg.norm(rows[:, :3] - outlet, axis=1) < 0.01] = OUTLET_PRESSURE
    write_vtp(path, rows[:, :3].copy(), numpy.arange(len(rows), dtype=numpy.int64), offsets,
              {"MaximumInscribedSphereRadius": rows[:, 3].copy(), "pressure_condition": pressure}, {})
