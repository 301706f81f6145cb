# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a vascular network: arteries and veins beside the pressures in them, as in the paper's Fig. 6(a).

Used by network.py while the program runs and by postprocessing/render_network.py on saved files; network_page.py draws
other views of it.
The camera is derived from the network's box: a flat network is seen face on, others from obliquely above; the views
are in parallel projection, side by side, or one above the other if that shows the network much larger. Vessels have
their true radii, but for those that would be too thin to be seen: the picture says how thin they may get.
Drawn with VTK itself for the reasons given in vessel_picture.py, at twice the size in each direction and averaged.
"""

import math

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

from network_tubes import TubeMesh
from picture_sheet import LARGE, Sheet, even_decades, even_ticks
from picture_tools import HEIGHT, VIRIDIS, WIDTH, colours, field_value, gather, write_png

FINENESS = 2
FLAT = 0.02  # a network whose thickness is below this share of its size is seen face on
AZIMUTH, ELEVATION = math.radians(15), math.radians(20)  # of the camera off the network's long side, if it is not flat
LEAST_RADII = [1.5, 1.0, 0.75, 0.5, 0.35]  # in pixels: the first that leaves white between the vessels
MOST_COVERED = 0.6  # share of a view that all vessels together may cover for that
KINDS = [("arteries", (0.80, 0.11, 0.13)), ("veins", (0.13, 0.33, 0.75)), ("unknown", (0.55, 0.55, 0.55))]
UNKNOWN = 2
MMHG = 133.322387415  # Pa
FLOW_UNITS = [(1e-3 / 60, "L/min"), (1e-6 / 60, "mL/min"), (1e-9 / 60, "\u00b5L/min"), (1e-12 / 60, "nL/min")]

# Layouts, in pixels: views and the places of their legends (left, bottom, width, height of the view; left, y, width).
SIDE_BY_SIDE = [((0, 100, 640, 570), (150, 56, 340)), ((640, 100, 640, 570), (790, 56, 340))]
STACKED = [((0, 375, 1000, 300), (1010, 510, 220)), ((0, 60, 1000, 300), (1010, 200, 220))]
MARGIN = 24


def vessels_of(network):
    """A row for each of this rank's vessels: start and end (m), radius (m), kind, flow (m3/s), two pressures (Pa)."""
    cells = network.GetLines() if network.IsA("vtkPolyData") else network.GetCells()
    count = cells.GetNumberOfCells()
    if count == 0:
        return numpy.empty((0, 11), numpy.float32)
    ends = vtk_to_numpy(cells.GetConnectivityArray())
    if len(ends) != 2 * count:
        raise ValueError("a network's cells must be lines between two points")
    position = vtk_to_numpy(network.GetPoints().GetData())
    start, end = ends.reshape(-1, 2).T

    def values(data, name, otherwise):
        array = data.GetArray(name)
        return numpy.full(data.GetNumberOfTuples() or len(position), otherwise) if array is None else vtk_to_numpy(array)

    of_cell = {"radius": 0.0, "kind": UNKNOWN, "flow": math.nan}
    of_cell = [values(network.GetCellData(), name, otherwise)[:count] for name, otherwise in of_cell.items()]
    pressure = values(network.GetPointData(), "pressure", math.nan)
    rows = [position[start], position[end], *of_cell, pressure[start], pressure[end]]
    return numpy.column_stack(rows).astype(numpy.float32)


def camera(corners):
    """Unit vectors to the right, upwards and towards the camera, for points [N, 3]."""
    size = numpy.ptp(corners, axis=0)
    thin = 2 - int(numpy.argmin(size[::-1]))  # z where there is a choice
    axes = numpy.eye(3)
    if size[thin] < FLAT * size.max():
        right, up = (axes[i] for i in range(3) if i != thin)
        return right, up, numpy.cross(right, up)
    # Up is z; the longer of x and y runs to the right and a little away.
    long = 0 if size[0] >= size[1] else 1
    aside = -axes[1] if long == 0 else axes[0]
    level = math.cos(AZIMUTH) * aside + math.sin(AZIMUTH) * axes[long]
    sight = math.cos(ELEVATION) * level + math.sin(ELEVATION) * axes[2]
    right = numpy.cross(axes[2], sight)
    right /= numpy.linalg.norm(right)
    return right, numpy.cross(sight, right), sight


class Framing:
    """Where a network's points come to lie in the views, in pixels; chosen once, so that frames can be compared."""

    def __init__(self, start, end, radius, layouts):
        """`layouts`: of which the first is taken, unless another one shows the network much larger."""
        self.axes = numpy.array(camera(numpy.concatenate([start, end])))
        start, end = start @ self.axes.T, end @ self.axes.T
        thickness = radius[:, None]
        low = (numpy.minimum(start, end) - thickness).min(axis=0)
        high = (numpy.maximum(start, end) + thickness).max(axis=0)
        self.middle, size = 0.5 * (low + high), numpy.maximum(high - low, 1e-12)[:2]

        def scale(layout):
            return min((numpy.array(layout[0][0][2:]) - 2 * MARGIN) / size)

        self.layout = layouts[0]
        for layout in layouts[1:]:
            if scale(layout) > 1.2 * scale(self.layout):
                self.layout = layout
        self.pixels_per_m = scale(self.layout)
        self.width, self.height = self.layout[0][0][2:]
        self.box = size * self.pixels_per_m

    def project(self, points):
        """Pixels to the right, upwards and towards the camera, from the middle of a view."""
        return (points @ self.axes.T - self.middle) * self.pixels_per_m

    def least_radius(self, start, end, radius):
        """The radius in pixels that every vessel gets at least."""
        length = numpy.linalg.norm((end - start)[:, :2], axis=1)
        for least in LEAST_RADII:
            if (2 * length * numpy.maximum(radius, least)).sum() <= MOST_COVERED * self.box.prod():
                break
        return least


class NetworkPicture:
    """Two views of the same vessels: by kind (or, where no kind is known, by flow), and by pressure."""

    layouts = [SIDE_BY_SIDE, STACKED]

    def __init__(self):
        self.window = self.framing = None  # of the first rank
        self.pressure_range = (math.inf, -math.inf)

    def save(self, path, network, time_s):
        """Draws the data of this moment. Collective."""
        rows = self.rows(network, time_s)
        if rows is not None:
            write_png(path, rows)

    def rows(self, network, time_s):
        """The picture of this moment [HEIGHT, WIDTH, 3] on the first rank, None on the others. Collective."""
        table = gather(vessels_of(network))
        if table is None:
            return None
        if len(table) == 0:
            raise ValueError("the network has no vessels to draw")
        start, end, radius = table[:, :3].astype(float), table[:, 3:6].astype(float), table[:, 6].astype(float)
        if self.framing is None:
            self.framing = Framing(start, end, radius, self.layouts)
            self._make_window()
        start, end, true = self.framing.project(start), self.framing.project(end), radius * self.framing.pixels_per_m
        least = self.framing.least_radius(start, end, true)
        mesh = TubeMesh(start, end, numpy.maximum(true, least))
        self.sheet.clear()
        # A coupled network is drawn as it was solved; what its wall does to it is told of the vessel alone.
        self.coupled = field_value(network, "chosen_start_x") is not None
        self.draw_views(network, mesh, table)
        self._write_title(network, len(table), time_s)
        self._mark_chosen(network)
        note = "radii: true" + (f", at least {least:g} px" if true.min() < least else "")
        self.sheet.scale_bar(MARGIN, 22, self.framing.pixels_per_m, about=110)
        self.sheet.text(WIDTH - MARGIN, 10, note, align="right")
        return self._render()

    def draw_views(self, network, mesh, table):
        """What is in the views and below them; `table`: the rows of all ranks, as of `vessels_of`."""
        self._draw_kind_or_flow(mesh, table[:, 7].astype(int), numpy.abs(table[:, 8].astype(float)))
        self._draw_pressure(mesh, table[:, 9:11] / MMHG)

    def _draw_kind_or_flow(self, mesh, kind, flow):
        _, (left, y, width) = self.framing.layout[0]
        positive = flow[flow > 0]  # neither 0 nor unknown
        if (kind == UNKNOWN).all() and len(positive) > 0:
            unit, name = flow_unit(positive.max())
            decades = 6 if width > 300 else 3  # so that their numbers do not touch
            steps, written = even_decades(positive.min() / unit, positive.max() / unit, decades)
            low, high = math.log10(steps[0]), math.log10(steps[-1])
            table = colours(VIRIDIS[::-1], "RGB")
            table.SetRange(low, high)
            logarithm = numpy.log10(numpy.maximum(flow / unit, steps[0]))
            self.show(0, mesh.surface(logarithm[mesh.vessel].astype(numpy.float32)), table)
            ticks = [((math.log10(step) - low) / (high - low), f"{step:g}") for step in written]
            self.sheet.colour_bar(left, y, width, table, f"flow / ({name})", ticks)
            return
        shades = numpy.rint(255 * numpy.array([shade for _, shade in KINDS])).astype(numpy.uint8)
        kind = numpy.clip(kind, 0, UNKNOWN)
        self.show(0, mesh.surface(shades[kind[mesh.vessel]]), None)
        entries = [entry for number, entry in enumerate(KINDS) if (kind == number).any()]
        self.sheet.key(left + 0.5 * width, y, entries)

    def _draw_pressure(self, mesh, pressure):
        _, (left, y, width) = self.framing.layout[1]
        known = pressure[numpy.isfinite(pressure)]
        low, high = self.pressure_range  # grows only, so that frames can be compared
        low, high = min(low, known.min(initial=math.inf)), max(high, known.max(initial=-math.inf))
        self.pressure_range = low, high
        table = colours(VIRIDIS, "RGB")
        table.SetNanColor(*KINDS[UNKNOWN][1], 1.0)
        if low > high:  # no pressure is known
            self.show(1, mesh.surface(numpy.full(mesh.vessel.shape, math.nan, numpy.float32)), table)
            self.sheet.key(left + 0.5 * width, y, [("pressure unknown", KINDS[UNKNOWN][1])])
            return
        ticks = even_ticks(low, high, about=width // 65)
        table.SetRange(ticks[0], ticks[-1])
        self.show(1, mesh.surface(pressure[mesh.vessel, mesh.at_end].astype(numpy.float32)), table)
        places = [((tick - ticks[0]) / (ticks[-1] - ticks[0]), f"{tick:g}") for tick in ticks]
        name = "pressure (wall intact) / mmHg" if self.coupled else "pressure / mmHg"
        self.sheet.colour_bar(left, y, width, table, name, places)

    def _write_title(self, network, drawn, time_s):
        shown, vessels = field_value(network, "shown") or drawn, field_value(network, "vessels")
        number = f"{int(shown):,}" if vessels in (None, shown) else f"{int(shown):,} of {int(vessels):,}"
        title = f"{number} vessel" if number == "1" else f"{number} vessels"
        inflow = field_value(network, "inflow")
        if inflow is not None:
            unit, name = flow_unit(abs(inflow))
            title += f"      inflow{' (wall intact)' if self.coupled else ''} {float(f'{inflow / unit:.3g}'):g} {name}"
        if time_s > 0 and not self.coupled:
            title += f"      t = {time_s:.4g} s" if time_s >= 1 else f"      t = {1e3 * time_s:.4g} ms"
        self.sheet.text(0.5 * WIDTH, HEIGHT - 32, title, LARGE, align="centre")

    def _mark_chosen(self, network):
        """A ring around the vessel whose wall is simulated, where the network is coupled with one."""
        ends = [[field_value(network, f"chosen_{end}_{axis}") for axis in "xyz"] for end in ("start", "end")]
        if None in ends[0] + ends[1]:
            return
        place = self.framing.project(numpy.array(ends))
        across = numpy.linalg.norm((place[1] - place[0])[:2])
        for left, bottom, width, height in (view for view, _ in self.framing.layout):
            middle = numpy.array([left + 0.5 * width, bottom + 0.5 * height]) + place.mean(axis=0)[:2]
            self.sheet.ring(*middle, max(10.0, 0.6 * across))

    def _make_window(self):
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(WIDTH * FINENESS, HEIGHT * FINENESS)
        self._view(0, 0, WIDTH, HEIGHT)  # what is white around the others
        self.views = [self._view(*view) for view, _ in self.framing.layout]
        self.sheet = Sheet(self.window, FINENESS)

    def _view(self, left, bottom, width, height):
        view = vtkRenderer()
        view.SetViewport(left / WIDTH, bottom / HEIGHT, (left + width) / WIDTH, (bottom + height) / HEIGHT)
        view.SetBackground(1.0, 1.0, 1.0)
        view.GetActiveCamera().ParallelProjectionOn()
        view.GetActiveCamera().SetParallelScale(0.5 * height)
        self.window.AddRenderer(view)
        return view

    def show(self, number, surface, table):
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(surface)
        if table is not None:
            mapper.SetLookupTable(table)
            mapper.UseLookupTableScalarRangeOn()
            mapper.InterpolateScalarsBeforeMappingOn()
        actor = vtkActor()
        actor.SetMapper(mapper)
        # One light from above the camera, as in the pictures of vessels.
        light = "max(0.0, dot(normalVCVSOutput, vec3(0.17, 0.5, 0.85)))"
        shading = f"gl_FragData[0] = vec4((0.35 + 0.7 * {light}) * diffuseColor, 1.0);"
        actor.GetShaderProperty().AddFragmentShaderReplacement("//VTK::Light::Impl", True, shading, False)
        view = self.views[number]
        view.RemoveAllViewProps()
        view.AddActor(actor)
        low, high = surface.GetBounds()[4:]
        view.GetActiveCamera().SetFocalPoint(0.0, 0.0, 0.0)
        view.GetActiveCamera().SetPosition(0.0, 0.0, high + 10)
        view.GetActiveCamera().SetClippingRange(5, high - low + 20)

    def _render(self):
        self.window.Render()
        pixels = vtkUnsignedCharArray()
        width, height = WIDTH * FINENESS, HEIGHT * FINENESS
        self.window.GetPixelData(0, 0, width - 1, height - 1, 0, pixels)
        fine = vtk_to_numpy(pixels).reshape(height, width, 3)[::-1]
        total = sum(fine[i::FINENESS, j::FINENESS].astype(numpy.uint16) for i in range(FINENESS) for j in range(FINENESS))
        return ((total + FINENESS**2 // 2) // FINENESS**2).astype(numpy.uint8)


def flow_unit(flow):
    """The unit (its size in m3/s, its name) in which a flow is a number from 1 on."""
    return next((unit for unit in FLOW_UNITS if flow >= unit[0]), FLOW_UNITS[-1])
