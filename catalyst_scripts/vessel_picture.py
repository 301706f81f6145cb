"""The picture of a vessel: displacement and damage of the same particles side by side, as in the paper's Fig. 1.

Used by vessel.py while the program runs and by postprocessing/render_particles.py on saved files.
Everything is derived from the particles: their box and spacing set the camera and the size of the spheres.
"""

import math

import numpy
from paraview.simple import (
    Calculator,
    ColorBy,
    CreateRenderView,
    GetColorTransferFunction,
    GetScalarBar,
    Line,
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
    """One view with the particles twice: on the left (or above) coloured by displacement, beside it by damage."""

    def __init__(self, particles):
        UpdatePipeline(proxy=particles)
        low, high, spacing = measure(particles)
        self.radius = 0.5 * max(high[0] - low[0], high[1] - low[1])
        self.length = high[2] - low[2]
        self.centre = 0.5 * (low + high)
        self.upright = self.length < SLENDER * 2 * self.radius
        self.largest_mm = 0.0

        self.view = CreateRenderView()
        self.view.ViewSize = [WIDTH, HEIGHT]
        self.view.UseColorPaletteForBackground = 0
        self.view.Background = [1.0, 1.0, 1.0]
        self.view.OrientationAxesVisibility = 0
        self.view.CenterAxesVisibility = 0
        self.view.UseFXAA = 1
        self._place_camera()

        self.scaled = Calculator(Input=particles, Function="1000*mag(displacement)", ResultArrayName=DISPLACEMENT_MM)
        self.displacement_colours = self._viridis(self._show(self.scaled, DISPLACEMENT_MM, -1, spacing))
        self.displacement_legend = self._legend(self.displacement_colours, "Displacement (mm)", first=True)
        damage_colours = self._grey_to_red(self._show(particles, "damage", +1, spacing))
        legend = self._legend(damage_colours, "Damage (fraction)", first=False)
        legend.CustomLabels = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]
        self._scale_bar()
        self.caption = self._text("", 24, "Upper Center")

    def update(self, step, time_s, pressure_pa=None):
        """Sets caption and colours for the data of this moment; the view draws when it is saved."""
        pressure = "" if pressure_pa is None else f"      p = {pressure_pa / 1e3:.1f} kPa"
        self.caption.Text = f"t = {time_s * 1e3:.3f} ms{pressure}      step {step}"
        UpdatePipeline(time=time_s, proxy=self.scaled)
        self._fit_displacement_range()

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

    def _place_camera(self):
        """Parallel projection, so that both halves are seen from the same side and lengths can be compared."""
        sight = numpy.array(
            [math.cos(ELEVATION) * math.cos(AZIMUTH), math.cos(ELEVATION) * math.sin(AZIMUTH), math.sin(ELEVATION)]
        )
        axis = numpy.array([0.0, 0.0, 1.0])
        along = axis - axis.dot(sight) * sight
        along /= numpy.linalg.norm(along)
        self.right, self.up = (numpy.cross(along, sight), along) if self.upright else (along, numpy.cross(sight, along))

        # Room for the vessel and for walls that move out by another radius, in each half of the picture.
        room = 2 * self.radius
        long_side = self.length * math.cos(ELEVATION) + 2 * room * math.sin(ELEVATION)
        if self.upright:
            self.scale = 0.5 * max(long_side / 0.90, 2 * room / 0.64 * HEIGHT / (WIDTH / 2))
            self.shift = 0.25 * 2 * self.scale * WIDTH / HEIGHT * self.right
        else:
            self.scale = 0.5 * max(long_side / 0.92 * HEIGHT / WIDTH, 2 * room / 0.25)
            self.shift = 0.2 * 2 * self.scale * -self.up
        self.sight = sight
        # Upright vessels stand a little to the left of their half's middle, as the legend stands to their right.
        self.focus = self.centre + (0.12 if self.upright else 0.0) * numpy.linalg.norm(self.shift) * self.right
        view = self.view
        view.CameraParallelProjection = 1
        view.CameraParallelScale = self.scale
        view.CameraFocalPoint = list(self.focus)
        view.CameraPosition = list(self.focus + 10 * (self.length + self.radius) * sight)
        view.CameraViewUp = list(self.up)

    def _show(self, source, array, side, spacing):
        display = Show(source, self.view)
        display.Representation = "Points"
        display.RenderPointsAsSpheres = 1
        display.PointSize = max(1.5, SPHERE * spacing / (2 * self.scale) * HEIGHT)
        display.Position = list(side * self.shift)
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

    def _legend(self, colours, title, first):
        bar = GetScalarBar(colours, self.view)
        bar.Title, bar.ComponentTitle = title, ""
        bar.TitleColor = bar.LabelColor = BLACK
        bar.TitleFontFamily = bar.LabelFontFamily = "Arial"
        bar.TitleFontSize, bar.LabelFontSize = 18, 18
        bar.HorizontalTitle = 1
        bar.AutomaticLabelFormat, bar.LabelFormat = 0, "%g"
        bar.UseCustomLabels, bar.AddRangeLabels = 1, 0
        bar.ScalarBarThickness = 18
        bar.WindowLocation = "Any Location"
        if self.upright:
            bar.Orientation, bar.ScalarBarLength = "Vertical", 0.5
            bar.Position = [0.40, 0.22] if first else [0.90, 0.22]
        else:
            bar.Orientation, bar.ScalarBarLength = "Horizontal", 0.35
            bar.Position = [0.325, 0.52] if first else [0.325, 0.10]
        bar.Visibility = 1
        return bar

    def _scale_bar(self):
        """A line of a round length at the bottom, with its length in millimetres beneath."""
        length = round_up(0.05 * 2 * self.scale * WIDTH / HEIGHT)
        middle = self.focus - 0.88 * self.scale * self.up + 4 * self.radius * self.sight
        line = Line(Point1=list(middle - 0.5 * length * self.right), Point2=list(middle + 0.5 * length * self.right))
        display = Show(line, self.view)
        display.AmbientColor = display.DiffuseColor = BLACK
        display.LineWidth = 3
        self._text(f"{1e3 * length:g} mm", 18, "Lower Center")

    def _text(self, text, size, place):
        source = Text(Text=text)
        display = Show(source, self.view)
        display.Color = BLACK
        display.FontFamily = "Arial"
        display.FontSize = size
        display.WindowLocation = place
        return source


def field_value(particles, name):
    """A number that the program sends with the particles (e.g. "pressure", in Pa), None where it sends none."""
    array = particles.GetClientSideObject().GetOutputDataObject(0).GetFieldData().GetArray(name)
    return None if array is None else array.GetTuple1(0)
