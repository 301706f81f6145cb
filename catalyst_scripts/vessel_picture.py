# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a vessel: two fields of the same particles side by side; displacement and damage, as in the paper's
Fig. 1, unless others are asked for.

Used by vessel.py, stress.py and coupled.py while the program runs and by postprocessing/render_particles.py on saved
files.
Everything is derived from the particles: their box and spacing set the camera and the size of the spheres.

Drawn with VTK itself: ParaView's views (paraview.simple) draw the same, but take two seconds longer to start and four
to five times as long for a picture. Most of the time goes into the work of the processor (no graphics card)
on each sphere and its pixels. So each rank leaves out what its other particles hide, and the first rank draws the rest.
"""

import math
from dataclasses import dataclass

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_INT, vtkDoubleArray, vtkPoints, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkLineSource
from vtkmodules.vtkParallelCore import vtkCommunicator
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTextActor

from picture_tools import HEIGHT, VIRIDIS, WIDTH, colours, gather, plain, reduce_over_ranks, round_up, write_png
from visible_spheres import visible

SPHERE = 1.2  # diameter of a sphere in spacings: neighbours touch, gaps between torn parts stay open
AZIMUTH, ELEVATION = math.radians(22.5), math.radians(28)  # of the camera, about the vessel's axis z
LEGEND = 96  # pixels below each view, for its colour bar: fragments that fly about would lie under a bar within the view
SLENDER = 4  # vessels longer than this many diameters lie down, one picture above the other
GREY_TO_RED = [(0.82, 0.82, 0.82), (0.98, 0.75, 0.55), (0.90, 0.33, 0.22), (0.45, 0.0, 0.05)]


@dataclass(frozen=True)
class Shown:
    """A field that a view shows: a vector by its length."""

    field: str
    title: str  # with the unit
    factor: float = 1.0  # from the field's SI unit to that of the title
    shades: tuple = tuple(VIRIDIS)
    space: str = "RGB"  # in which shades are mixed
    bottom: float = 0.0  # of the colours
    top: float = None  # of the colours; None: that of the largest value so far, rounded up
    whole_wall_only: bool = False  # the largest value is that of particles that have lost no bond

    def values(self, particles):
        values = column(particles, self.field)
        return self.factor * (values if values.ndim == 1 else numpy.sqrt(numpy.einsum("ij,ij->i", values, values)))


DISPLACEMENT = Shown("displacement", "Displacement (mm)", 1e3)
# A particle on the edge of a crack has lost about half of its bonds.
DAMAGE = Shown("damage", "Damage (fraction)", shades=tuple(GREY_TO_RED), space="Lab", top=0.5)


def column(particles, name):
    """A field, or the "position"s, of this rank's particles."""
    if particles.GetNumberOfPoints() == 0:
        return numpy.empty((0, 3) if name in ("position", "displacement") else 0)
    data = particles.GetPoints().GetData() if name == "position" else particles.GetPointData().GetArray(name)
    return vtk_to_numpy(data)


def measure(particles):
    """The box of the particles at rest (low corner, high corner) and their spacing, the same on all ranks."""
    low, high, spacing = numpy.full(3, math.inf), numpy.full(3, -math.inf), math.inf
    if particles.GetNumberOfPoints() > 1:
        rest = column(particles, "position") - column(particles, "displacement")
        low, high = rest.min(axis=0), rest.max(axis=0)
        filled = (numpy.prod(high - low) / len(rest)) ** (1 / 3)  # the spacing if particles filled their box: too wide
        nearest = []
        for point in rest[:: max(1, len(rest) // 15)]:
            near = rest[abs(rest[:, 2] - point[2]) <= 2 * filled]
            squared = (((near if len(near) > 1 else rest) - point) ** 2).sum(axis=1)
            nearest.append(numpy.partition(squared, 1)[1])  # [0] is the point itself
        spacing = math.sqrt(numpy.median(nearest))
    low = reduce_over_ranks(low, vtkCommunicator.MIN_OP)
    high = reduce_over_ranks(high, vtkCommunicator.MAX_OP)
    spacing = reduce_over_ranks([spacing], vtkCommunicator.MIN_OP)[0]
    return low, high, spacing


class VesselPicture:
    """Two views of the same particles from the same side: one field on the left (or above), another beside it."""

    def __init__(self, particles, shown=(DISPLACEMENT, DAMAGE), cut_open=False):
        """`cut_open`: without the half of the vessel that is nearer to the camera, so that the lumen is seen."""
        low, high, spacing = measure(particles)
        self.radius = 0.5 * max(high[0] - low[0], high[1] - low[1])
        self.length = high[2] - low[2]
        self.centre = 0.5 * (low + high)
        self.upright = self.length < SLENDER * 2 * self.radius
        self.width = WIDTH // 2 if self.upright else WIDTH  # pixels of one view, without its colour bar
        self.height = (HEIGHT if self.upright else HEIGHT // 2) - LEGEND
        self.shown = shown
        self.cut_open = cut_open
        self.largest = [0.0 for _ in shown]
        self._choose_camera()
        self.sphere_pixels = max(2.5, SPHERE * spacing / (2 * self.scale) * self.height)
        self.window = None  # of the first rank

    def save(self, path, particles, step, time_s, pressure_pa=None):
        """Draws the data of this moment. Collective."""
        rows = self.rows(particles, step, time_s, pressure_pa)
        if rows is not None:
            write_png(path, rows)

    def rows(self, particles, step, time_s, pressure_pa=None, note=""):
        """The picture of this moment [HEIGHT, WIDTH, 3] on the first rank, None on the others. Collective."""
        damage, position = column(particles, "damage"), column(particles, "position")
        values = [shown.values(particles) for shown in self.shown]
        there = ~numpy.isnan(damage)  # where a thin spot leaves no particle, its damage is not a number
        if self.cut_open:
            there &= (position - column(particles, "displacement") - self.centre) @ self.toward_camera <= 0
        if not there.all():
            position, damage, values = position[there], damage[there], [v[there] for v in values]
        position = position.astype(numpy.float32)
        tops = self._tops(values, damage)
        seen = self._seen(position)
        table = gather(numpy.column_stack([position[seen], *(v[seen] for v in values)]).astype(numpy.float32))
        if table is None:
            return None
        if self.window is None:
            self._make_window()
        pressure = "" if pressure_pa is None else f"      p = {pressure_pa / 1e3:.1f} kPa"
        self.moment.SetInput(f"t = {time_s * 1e3:.3f} ms{pressure}{note}")
        self.step.SetInput(f"step {step}")
        for view, (largest, top) in zip(self.views, tops):
            view.set_top(top, largest > top)
        self._set_particles(table)
        self.window.Render()
        pixels = vtkUnsignedCharArray()
        self.window.GetPixelData(0, 0, WIDTH - 1, HEIGHT - 1, 0, pixels)
        return vtk_to_numpy(pixels).reshape(HEIGHT, WIDTH, 3)[::-1]

    def _seen(self, position):
        """The numbers of the particles that no others of this rank hide from the camera, and perhaps a few more."""
        pixels_per_m = self.height / (2 * self.scale)
        axes = (numpy.array([self.up, self.right, self.sight]) * pixels_per_m).astype(numpy.float32)
        up, across, depth = axes @ (position - self.centre.astype(numpy.float32)).T
        radius = 0.5 * self.sphere_pixels
        return visible(up + 0.5 * self.height, across + 0.5 * self.width, depth, radius, self.height, self.width)

    def _tops(self, values, damage):
        """The largest value at this moment and the top of the colours, of each view. Collective.

        The top is rounded up (1, 2, 5, 10 ...) from the largest value so far, so that few frames of a movie change it;
        that of displacement is the vessel's radius at most, lest flying fragments hide the rest."""
        whole = damage == 0
        largest = [(v[whole] if s.whole_wall_only else v).max(initial=0.0) for s, v in zip(self.shown, values)]
        largest = reduce_over_ranks(largest, vtkCommunicator.MAX_OP)
        self.largest = numpy.maximum(self.largest, largest)
        return list(zip(largest, map(self._top, self.shown, self.largest)))

    def _top(self, shown, largest):
        if shown.top is not None:
            return shown.top
        if shown.field == "displacement":
            radius = shown.factor * self.radius
            return min(round_up(max(largest, 0.01 * radius)), round_up(radius))
        return shown.bottom + round_up(max(largest - shown.bottom, 1e-3))

    def _choose_camera(self):
        """Parallel projection, so that lengths can be compared; looking down on the vessel's end a little."""
        self.sight = numpy.array(
            [math.cos(ELEVATION) * math.cos(AZIMUTH), math.cos(ELEVATION) * math.sin(AZIMUTH), math.sin(ELEVATION)]
        )
        self.toward_camera = numpy.array([math.cos(AZIMUTH), math.sin(AZIMUTH), 0.0])  # across the axis
        axis = numpy.array([0.0, 0.0, 1.0])
        along = axis - axis.dot(self.sight) * self.sight
        along /= numpy.linalg.norm(along)

        # Room for the vessel and for walls that move out by another radius; `scale` is half of a view's height.
        room = 2 * self.radius
        long_side = self.length * math.cos(ELEVATION) + 2 * room * math.sin(ELEVATION)
        shape = self.width / self.height
        if self.upright:
            self.right, self.up = numpy.cross(along, self.sight), along
            self.scale = 0.5 * max(long_side / 0.92, 2 * room / 0.92 / shape)
        else:
            self.right, self.up = along, numpy.cross(self.sight, along)
            self.scale = 0.5 * max(long_side / 0.92 / shape, 2 * room / 0.84)

    def _make_window(self):
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(WIDTH, HEIGHT)
        corners = [(0, 0), (WIDTH // 2, 0)] if self.upright else [(0, HEIGHT // 2), (0, 0)]  # pixels, bottom left
        layers = [self._view(left, bottom + LEGEND) for left, bottom in corners]
        below = [self._layer(left, bottom, LEGEND) for left, bottom in corners]
        self.views = [
            _View(*parts, self.sphere_pixels, self.width) for parts in zip(self.shown, layers, below, strict=True)
        ]
        first, second = layers
        self.moment = text(first, 22, (0.01, 0.98))
        self.step = text(second, 22, (0.99, 0.98))
        self.step.GetTextProperty().SetJustificationToRight()
        for line in (self.moment, self.step):
            line.GetTextProperty().SetVerticalJustificationToTop()
        self._scale_bar(first)

    def _layer(self, left, bottom, height):
        """A white part of the window, as wide as a view."""
        layer = vtkRenderer()
        layer.SetViewport(left / WIDTH, bottom / HEIGHT, (left + self.width) / WIDTH, (bottom + height) / HEIGHT)
        layer.SetBackground(1.0, 1.0, 1.0)
        self.window.AddRenderer(layer)
        return layer

    def _view(self, left, bottom):
        view = self._layer(left, bottom, self.height)
        camera = view.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetParallelScale(self.scale)
        camera.SetFocalPoint(*self.centre)
        distance = 10 * (self.length + self.radius)
        camera.SetPosition(*(self.centre + distance * self.sight))
        camera.SetViewUp(*self.up)
        camera.SetClippingRange(0.1 * distance, 1.9 * distance)  # VTK would look for one in each picture
        return view

    def _set_particles(self, table):
        points = vtkPoints()
        points.SetData(numpy_to_vtk(numpy.ascontiguousarray(table[:, :3]), deep=True))
        numbers = numpy.arange(len(table) + 1, dtype=numpy.int32)
        vertices = vtkCellArray()
        vertices.SetData(numpy_to_vtk(numbers, True, VTK_INT), numpy_to_vtk(numbers[:-1], True, VTK_INT))
        for number, view in enumerate(self.views):
            view.set_particles(points, vertices, table[:, 3 + number])

    def _scale_bar(self, view):
        """A line of a round length at the bottom left, with its length in millimetres above."""
        width = 2 * self.scale * self.width / self.height
        length = round_up((0.1 if self.upright else 0.05) * width)
        corner = self.centre - 0.93 * self.scale * self.up - 0.47 * width * self.right + 4 * self.radius * self.sight
        line = vtkLineSource()
        line.SetPoint1(*corner)
        line.SetPoint2(*(corner + length * self.right))
        mapper = vtkPolyDataMapper()
        mapper.SetInputConnection(line.GetOutputPort())
        actor = vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(0.0, 0.0, 0.0)
        actor.GetProperty().SetLineWidth(3)
        view.AddActor(actor)
        text(view, 18, (0.03, 0.05), f"{1e3 * length:g} mm")


class _View:
    """Particles in the colours of one field, with the colour bar below them."""

    def __init__(self, shown, layer, below, sphere_pixels, width):
        self.bottom, self.top = shown.bottom, None
        self.colours = colours(shown.shades, shown.space)
        self.body = self._make_body(layer, sphere_pixels)
        self.legend = self._make_legend(shown.title, below, width)

    def set_particles(self, points, vertices, values):
        self.body.SetPoints(points)
        self.body.SetVerts(vertices)
        self.body.GetPointData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(values), deep=True))

    def set_top(self, top, more):
        """`more`: some values are beyond `top`."""
        self.legend.SetDrawAboveRangeSwatch(more)
        if self.top != top:
            self.top = top
            self.colours.SetRange(self.bottom, top)
            set_labels(self.legend, self.bottom, top)

    def _make_body(self, layer, sphere_pixels):
        """Spheres at points that come later."""
        body = vtkPolyData()
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(body)
        mapper.SetLookupTable(self.colours)
        mapper.UseLookupTableScalarRangeOn()
        actor = vtkActor()
        actor.SetMapper(mapper)
        looks = actor.GetProperty()
        looks.SetRenderPointsAsSpheres(True)
        looks.SetPointSize(sphere_pixels)
        # One light from above the camera, without VTK's general sums over lights: saves a quarter of the time.
        light = "max(0.0, dot(normalVCVSOutput, vec3(0.17, 0.5, 0.85)))"
        shading = f"gl_FragData[0] = vec4((0.35 + 0.7 * {light}) * diffuseColor, 1.0);"
        actor.GetShaderProperty().AddFragmentShaderReplacement("//VTK::Light::Impl", True, shading, False)
        layer.AddActor(actor)
        return body

    def _make_legend(self, title, below, width):
        bar = vtkScalarBarActor()
        bar.SetLookupTable(self.colours)
        self.colours.SetAboveRangeColor(*self.colours.GetTableValue(self.colours.GetNumberOfTableValues() - 1))
        self.colours.UseAboveRangeColorOn()
        bar.SetAboveRangeAnnotation("more")
        bar.UnconstrainedFontSizeOn()
        for style in (bar.GetLabelTextProperty(), bar.GetAnnotationTextProperty()):
            plain(style, 18)
        bar.SetOrientationToHorizontal()
        bar.SetLabelFormat("%g")
        bar.SetBarRatio(0.4)
        share = 320 / width
        bar.SetPosition(0.5 - share / 2, 0.25)  # what is written of values beyond comes below
        bar.SetWidth(share)
        bar.SetHeight(0.5)
        title = text(below, 18, (0.5, 0.78), title)
        title.GetTextProperty().SetJustificationToCentered()
        below.AddActor2D(bar)
        return bar


def set_labels(bar, bottom, top):
    labels = vtkDoubleArray()
    for fifth in range(6):
        labels.InsertNextValue(bottom + (top - bottom) * fifth / 5)
    bar.SetCustomLabels(labels)
    bar.UseCustomLabelsOn()


def text(view, size, position, line=""):
    """A line of text at a position (0 ... 1) in a view."""
    actor = vtkTextActor()
    actor.SetInput(line)
    style = actor.GetTextProperty()
    plain(style, size)
    style.SetBackgroundColor(1.0, 1.0, 1.0)  # so that it can be read on top of fragments
    style.SetBackgroundOpacity(0.8)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(*position)
    view.AddActor2D(actor)
    return actor
