"""The picture of a vessel: displacement and damage of the same particles side by side, as in the paper's Fig. 1.

Used by vessel.py while the program runs and by postprocessing/render_particles.py on saved files.
Everything is derived from the particles: their box and spacing set the camera and the size of the spheres.
"""

import math

import numpy
from paraview.simple import (
    Calculator,
    ColorBy,
    CreateLayout,
    CreateRenderView,
    GetColorTransferFunction,
    GetScalarBar,
    Line,
    SaveScreenshot,
    Show,
    Text,
    UpdatePipeline,
)
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkParallelCore import vtkCommunicator, vtkMultiProcessController

WIDTH, HEIGHT = 1280, 720  # even numbers, as movies need them
SPHERE = 1.2  # diameter of a sphere in spacings: neighbours touch, gaps between torn parts stay open
AZIMUTH, ELEVATION = math.radians(22.5), math.radians(28)  # of the camera, about the vessel's axis z
SLENDER = 4  # vessels longer than this many diameters lie down, one picture above the other
DAMAGE_RANGE = 0.5  # a particle on the edge of a crack has lost about half of its bonds
BLACK = [0.0, 0.0, 0.0]

DISPLACEMENT_MM = "displacement_mm"


def reduce_over_ranks(values, operation):
    """Element-wise minimum or maximum over all ranks."""
    controller = vtkMultiProcessController.GetGlobalController()
    if controller is None or controller.GetNumberOfProcesses() == 1:
        return numpy.array(values, float)
    send, receive = vtkDoubleArray(), vtkDoubleArray()
    for value in values:
        send.InsertNextValue(value)
    receive.SetNumberOfValues(len(values))
    controller.AllReduce(send, receive, operation)
    return vtk_to_numpy(receive).copy()


def measure(particles):
    """The box of the particles at rest (low corner, high corner) and their spacing, the same on all ranks."""
    data = particles.GetClientSideObject().GetOutputDataObject(0)
    low, high, spacing = numpy.full(3, math.inf), numpy.full(3, -math.inf), math.inf
    if data.GetNumberOfPoints() > 1:
        moved = vtk_to_numpy(data.GetPoints().GetData())
        rest = moved - vtk_to_numpy(data.GetPointData().GetArray("displacement"))
        low, high = rest.min(axis=0), rest.max(axis=0)
        sample = rest[:: max(1, len(rest) // 50)]
        nearest = []
        for point in sample:
            squared = ((rest - point) ** 2).sum(axis=1)
            nearest.append(numpy.partition(squared, 1)[1])  # [0] is the point itself
        spacing = math.sqrt(numpy.median(nearest))
    low = reduce_over_ranks(low, vtkCommunicator.MIN_OP)
    high = reduce_over_ranks(high, vtkCommunicator.MAX_OP)
    spacing = reduce_over_ranks([spacing], vtkCommunicator.MIN_OP)[0]
    return low, high, spacing


def round_up(value):
    """The next number of 1, 2, 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= value * (1 - 1e-9))


class VesselPicture:
    """Two views of the same particles from the same side: by displacement on the left (or above), beside it by damage."""

    def __init__(self, particles):
        UpdatePipeline(proxy=particles)
        low, high, spacing = measure(particles)
        self.radius = 0.5 * max(high[0] - low[0], high[1] - low[1])
        self.length = high[2] - low[2]
        self.centre = 0.5 * (low + high)
        self.upright = self.length < SLENDER * 2 * self.radius
        self.width, self.height = (WIDTH // 2, HEIGHT) if self.upright else (WIDTH, HEIGHT // 2)  # of one view
        self.largest_mm = 0.0
        self._choose_camera()

        self.scaled = Calculator(Input=particles, Function="1000*mag(displacement)", ResultArrayName=DISPLACEMENT_MM)
        self.views = first, second = self._view(), self._view()
        self.displacement_colours = self._viridis(self._show(self.scaled, DISPLACEMENT_MM, first, spacing))
        self.displacement_legend = self._legend(self.displacement_colours, "Displacement (mm)", first)
        damage_colours = self._grey_to_red(self._show(particles, "damage", second, spacing))
        legend = self._legend(damage_colours, "Damage (fraction)", second)
        legend.CustomLabels = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]
        self.moment = text(first, 22, "Upper Left Corner")
        self.step = text(second, 22, "Upper Right Corner")
        self._scale_bar(first)

        self.layout = CreateLayout("vessel")
        (self.layout.SplitHorizontal if self.upright else self.layout.SplitVertical)(0, 0.5)
        self.layout.AssignView(1, first)
        self.layout.AssignView(2, second)
        self.layout.SetSize(WIDTH, HEIGHT)

    def save(self, path, step, time_s, pressure_pa=None):
        """Draws the data of this moment."""
        pressure = "" if pressure_pa is None else f"      p = {pressure_pa / 1e3:.1f} kPa"
        self.moment.Text = f"t = {time_s * 1e3:.3f} ms{pressure}"
        self.step.Text = f"step {step}"
        for view in self.views:
            view.ViewTime = time_s
        UpdatePipeline(time=time_s, proxy=self.scaled)
        self._fit_displacement_range()
        SaveScreenshot(str(path), self.layout, ImageResolution=[WIDTH, HEIGHT], SeparatorWidth=0)

    def _fit_displacement_range(self):
        """Zero to the largest displacement so far, rounded up (1, 2, 5, 10 ...), so that few frames of a
        movie change it; at most the vessel's radius, lest flying fragments hide the rest."""
        data = self.scaled.GetClientSideObject().GetOutputDataObject(0)
        array = data.GetPointData().GetArray(DISPLACEMENT_MM)  # of this rank's particles
        largest = array.GetRange()[1] if data.GetNumberOfPoints() > 0 else 0.0
        largest = reduce_over_ranks([largest], vtkCommunicator.MAX_OP)[0]
        radius_mm = 1e3 * self.radius
        self.largest_mm = max(self.largest_mm, largest, 0.01 * radius_mm)
        top = min(round_up(self.largest_mm), round_up(radius_mm))
        self.displacement_colours.RescaleTransferFunction(0.0, top)
        self.displacement_legend.CustomLabels = [top * fifth / 5 for fifth in range(6)]

    def _choose_camera(self):
        """Parallel projection, so that lengths can be compared; looking down on the vessel's end a little."""
        self.sight = numpy.array(
            [math.cos(ELEVATION) * math.cos(AZIMUTH), math.cos(ELEVATION) * math.sin(AZIMUTH), math.sin(ELEVATION)]
        )
        axis = numpy.array([0.0, 0.0, 1.0])
        along = axis - axis.dot(self.sight) * self.sight
        along /= numpy.linalg.norm(along)

        # Room for the vessel and for walls that move out by another radius; `scale` is half of a view's height.
        # The legend stands on the right of an upright vessel, below a lying one, which make way for it a little.
        room = 2 * self.radius
        long_side = self.length * math.cos(ELEVATION) + 2 * room * math.sin(ELEVATION)
        shape = self.width / self.height
        if self.upright:
            self.right, self.up = numpy.cross(along, self.sight), along
            self.scale = 0.5 * max(long_side / 0.90, 2 * room / 0.64 / shape)
            self.focus = self.centre + 0.06 * 2 * self.scale * shape * self.right
        else:
            self.right, self.up = along, numpy.cross(self.sight, along)
            self.scale = 0.5 * max(long_side / 0.92 / shape, 2 * room / 0.6)
            self.focus = self.centre - 0.08 * 2 * self.scale * self.up

    def _view(self):
        view = CreateRenderView()
        view.ViewSize = [self.width, self.height]
        view.UseColorPaletteForBackground = 0
        view.Background = [1.0, 1.0, 1.0]
        view.OrientationAxesVisibility = 0
        view.CenterAxesVisibility = 0
        view.CameraParallelProjection = 1
        view.CameraParallelScale = self.scale
        view.CameraFocalPoint = list(self.focus)
        view.CameraPosition = list(self.focus + 10 * (self.length + self.radius) * self.sight)
        view.CameraViewUp = list(self.up)
        return view

    def _show(self, source, array, view, spacing):
        display = Show(source, view)
        display.Representation = "Points"
        display.RenderPointsAsSpheres = 1
        display.PointSize = max(1.5, SPHERE * spacing / (2 * self.scale) * self.height)
        display.Interpolation = "Gouraud"
        display.Ambient = 0.2
        display.Specular = 0.15
        ColorBy(display, ("POINTS", array), separate=True)  # colours of its own: scripts share those named by an array
        return display

    def _viridis(self, display):
        colours = GetColorTransferFunction(DISPLACEMENT_MM, display, separate=True)
        colours.AutomaticRescaleRangeMode = "Never"
        colours.ApplyPreset("Viridis (matplotlib)", False)
        return colours

    def _grey_to_red(self, display):
        colours = GetColorTransferFunction("damage", display, separate=True)
        colours.AutomaticRescaleRangeMode = "Never"
        shades = [(0.82, 0.82, 0.82), (0.98, 0.75, 0.55), (0.90, 0.33, 0.22), (0.45, 0.0, 0.05)]
        points = []
        for number, shade in enumerate(shades):
            points += [DAMAGE_RANGE * number / (len(shades) - 1), *shade]
        colours.ColorSpace = "Lab"
        colours.RGBPoints = points
        return colours

    def _legend(self, colours, title, view):
        bar = GetScalarBar(colours, view)
        bar.Title, bar.ComponentTitle = title, ""
        bar.TitleColor = bar.LabelColor = BLACK
        bar.TitleFontFamily = bar.LabelFontFamily = "Arial"
        bar.TitleFontSize = bar.LabelFontSize = 18
        bar.HorizontalTitle = 1
        bar.AutomaticLabelFormat, bar.LabelFormat = 0, "%g"
        bar.UseCustomLabels, bar.AddRangeLabels = 1, 0
        bar.ScalarBarThickness = 18
        bar.DrawBackground, bar.BackgroundColor, bar.BackgroundPadding = 1, [1.0, 1.0, 1.0, 0.8], 6  # on top of fragments
        bar.WindowLocation = "Any Location"
        if self.upright:
            bar.Orientation, bar.ScalarBarLength, bar.Position = "Vertical", 0.5, [0.80, 0.22]
        else:
            bar.Orientation, bar.ScalarBarLength, bar.Position = "Horizontal", 0.35, [0.325, 0.06]
        bar.Visibility = 1
        return bar

    def _scale_bar(self, view):
        """A line of a round length at the bottom left, with its length in millimetres above."""
        width = 2 * self.scale * self.width / self.height
        length = round_up((0.1 if self.upright else 0.05) * width)
        corner = self.focus - 0.93 * self.scale * self.up - 0.47 * width * self.right + 4 * self.radius * self.sight
        display = Show(Line(Point1=list(corner), Point2=list(corner + length * self.right)), view)
        display.AmbientColor = display.DiffuseColor = BLACK
        display.LineWidth = 3
        text(view, 18, "Any Location", [0.03, 0.05]).Text = f"{1e3 * length:g} mm"


def text(view, size, place, position=(0.0, 0.0)):
    """An empty line of text at one of ParaView's named places or, for "Any Location", at a position (0 ... 1)."""
    source = Text(Text="")
    display = Show(source, view)
    display.Color = BLACK
    display.FontFamily = "Arial"
    display.FontSize = size
    display.WindowLocation = place
    display.Position = list(position)
    return source


def field_value(particles, name):
    """A number that goes with the particles (e.g. "pressure", in Pa), None where there is none of this name."""
    array = particles.GetClientSideObject().GetOutputDataObject(0).GetFieldData().GetArray(name)
    return None if array is None else array.GetTuple1(0)
