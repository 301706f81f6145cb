# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a vessel: displacement and damage of the same particles side by side, as in the paper's Fig. 1.

Used by vessel.py while the program runs and by postprocessing/render_particles.py on saved files.
Everything is derived from the particles: their box and spacing set the camera and the size of the spheres.

Drawn with VTK itself: ParaView's views (paraview.simple) draw the same, but take two seconds longer to start and four
to five times as long for a picture. Most of the time goes into the work of the processor (no graphics card)
on each sphere and its pixels. So each rank leaves out what its other particles hide, and the first rank draws the rest.
"""

import math

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
DAMAGE_RANGE = 0.5  # a particle on the edge of a crack has lost about half of its bonds
GREY_TO_RED = [(0.82, 0.82, 0.82), (0.98, 0.75, 0.55), (0.90, 0.33, 0.22), (0.45, 0.0, 0.05)]


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
    """Two views of the same particles from the same side: by displacement on the left (or above), beside it by damage."""

    def __init__(self, particles):
        low, high, spacing = measure(particles)
        self.radius = 0.5 * max(high[0] - low[0], high[1] - low[1])
        self.length = high[2] - low[2]
        self.centre = 0.5 * (low + high)
        self.upright = self.length < SLENDER * 2 * self.radius
        self.width = WIDTH // 2 if self.upright else WIDTH  # pixels of one view, without its colour bar
        self.height = (HEIGHT if self.upright else HEIGHT // 2) - LEGEND
        self.largest_mm = 0.0
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
        damage = column(particles, "damage")
        position, displacement = column(particles, "position"), column(particles, "displacement")
        there = ~numpy.isnan(damage)  # where a thin spot leaves no particle, its damage is not a number
        if not there.all():
            position, displacement, damage = position[there], displacement[there], damage[there]
        position = position.astype(numpy.float32)
        displacement_mm = 1e3 * numpy.sqrt(numpy.einsum("ij,ij->i", displacement, displacement))
        largest_mm, most_damage = reduce_over_ranks(
            [displacement_mm.max(initial=0.0), damage.max(initial=0.0)], vtkCommunicator.MAX_OP
        )
        top = self._displacement_range(largest_mm)
        seen = self._seen(position)
        table = numpy.column_stack([position[seen], displacement_mm[seen], damage[seen]]).astype(numpy.float32)
        table = gather(table)
        if table is None:
            return None
        if self.window is None:
            self._make_window()
        pressure = "" if pressure_pa is None else f"      p = {pressure_pa / 1e3:.1f} kPa"
        self.moment.SetInput(f"t = {time_s * 1e3:.3f} ms{pressure}{note}")
        self.step.SetInput(f"step {step}")
        self._set_displacement_range(top)
        self.displacement_legend.SetDrawAboveRangeSwatch(largest_mm > top)
        self.damage_legend.SetDrawAboveRangeSwatch(most_damage > DAMAGE_RANGE)
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

    def _displacement_range(self, largest_mm):
        """Zero to the largest displacement so far, rounded up (1, 2, 5, 10 ...), so that few frames of a
        movie change it; at most the vessel's radius, lest flying fragments hide the rest."""
        radius_mm = 1e3 * self.radius
        self.largest_mm = max(self.largest_mm, largest_mm, 0.01 * radius_mm)
        return min(round_up(self.largest_mm), round_up(radius_mm))

    def _choose_camera(self):
        """Parallel projection, so that lengths can be compared; looking down on the vessel's end a little."""
        self.sight = numpy.array(
            [math.cos(ELEVATION) * math.cos(AZIMUTH), math.cos(ELEVATION) * math.sin(AZIMUTH), math.sin(ELEVATION)]
        )
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
        first, second = [self._view(left, bottom + LEGEND) for left, bottom in corners]
        below_first, below_second = [self._layer(left, bottom, LEGEND) for left, bottom in corners]
        self.displacement_colours = colours(VIRIDIS, "RGB")
        damage_colours = colours(GREY_TO_RED, "Lab")
        damage_colours.SetRange(0.0, DAMAGE_RANGE)
        self.displacement_bodies = self._body(first, self.displacement_colours)
        self.damage_bodies = self._body(second, damage_colours)
        self.displacement_legend = self._legend(self.displacement_colours, "Displacement (mm)", below_first)
        self.damage_legend = self._legend(damage_colours, "Damage (fraction)", below_second)
        set_labels(self.damage_legend, DAMAGE_RANGE)
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

    def _body(self, view, colours):
        """Spheres at points that come later."""
        body = vtkPolyData()
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(body)
        mapper.SetLookupTable(colours)
        mapper.UseLookupTableScalarRangeOn()
        actor = vtkActor()
        actor.SetMapper(mapper)
        looks = actor.GetProperty()
        looks.SetRenderPointsAsSpheres(True)
        looks.SetPointSize(self.sphere_pixels)
        # One light from above the camera, without VTK's general sums over lights: saves a quarter of the time.
        light = "max(0.0, dot(normalVCVSOutput, vec3(0.17, 0.5, 0.85)))"
        shading = f"gl_FragData[0] = vec4((0.35 + 0.7 * {light}) * diffuseColor, 1.0);"
        actor.GetShaderProperty().AddFragmentShaderReplacement("//VTK::Light::Impl", True, shading, False)
        view.AddActor(actor)
        return body

    def _set_particles(self, table):
        points = vtkPoints()
        points.SetData(numpy_to_vtk(numpy.ascontiguousarray(table[:, :3]), deep=True))
        numbers = numpy.arange(len(table) + 1, dtype=numpy.int32)
        vertices = vtkCellArray()
        vertices.SetData(numpy_to_vtk(numbers, True, VTK_INT), numpy_to_vtk(numbers[:-1], True, VTK_INT))
        for body, values in ((self.displacement_bodies, table[:, 3]), (self.damage_bodies, table[:, 4])):
            body.SetPoints(points)
            body.SetVerts(vertices)
            body.GetPointData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(values), deep=True))

    def _set_displacement_range(self, top):
        if self.displacement_colours.GetRange()[1] == top:
            return
        self.displacement_colours.SetRange(0.0, top)
        set_labels(self.displacement_legend, top)

    def _legend(self, colours, title, below):
        bar = vtkScalarBarActor()
        bar.SetLookupTable(colours)
        colours.SetAboveRangeColor(*colours.GetTableValue(colours.GetNumberOfTableValues() - 1))
        colours.UseAboveRangeColorOn()
        bar.SetAboveRangeAnnotation("more")
        bar.UnconstrainedFontSizeOn()
        for style in (bar.GetLabelTextProperty(), bar.GetAnnotationTextProperty()):
            plain(style, 18)
        bar.SetOrientationToHorizontal()
        bar.SetLabelFormat("%g")
        bar.SetBarRatio(0.4)
        width = 320 / self.width
        bar.SetPosition(0.5 - width / 2, 0.25)  # what is written of values beyond comes below
        bar.SetWidth(width)
        bar.SetHeight(0.5)
        title = text(below, 18, (0.5, 0.78), title)
        title.GetTextProperty().SetJustificationToCentered()
        below.AddActor2D(bar)
        return bar

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


def set_labels(bar, top):
    labels = vtkDoubleArray()
    for fifth in range(6):
        labels.InsertNextValue(top * fifth / 5)
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
