# SPDX-License-Identifier: BSD-3-Clause
"""A plain Catalyst script to start from: copy it, change it, and name it in the input file.

    [insitu]
    scripts = ["my_script.py"]

A script runs once from top to bottom at the first picture and builds a pipeline, just as in pvpython; then, at
every later step, ParaView passes new data through it and writes what the extractors ask for.
Easier still: open results/.../particles.xdmf in ParaView, make a picture, and choose File > Save Catalyst State: readers
of results become sources of the run. More in docs/pictures.md.
"""

from paraview import catalyst
from paraview.simple import (
    ColorBy,
    CreateExtractor,
    CreateRenderView,
    GetColorTransferFunction,
    PVTrivialProducer,
    ResetCamera,
    Show,
)

# What the program should compute and send (a list of literal names, on one or several lines). Without this line all:
# displacement (m), velocity (m/s), force_density (N/m3), damage (0 ... 1), strain_energy_density (J/m3).
# Damage is not a number where a thin spot of the wall leaves no particle: a threshold on it hides these.
# Of a network (channel "network", lines; see network.py) a list network_fields says the same: pressure (Pa, at points),
# flow (m3/s), radius (m), generation, kind (0 artery, 1 vein, 2 unknown), wall_shear_stress (Pa), hoop_strain.
fields = ["damage"]

# The particles, as points: copies, so that nothing here changes the run. With them come numbers such as `pressure` (Pa), `time` (s) and `step`, as field data.
particles = PVTrivialProducer(registrationName="particles")

view = CreateRenderView()
view.ViewSize = [800, 600]
view.UseColorPaletteForBackground = 0
view.Background = [1.0, 1.0, 1.0]

display = Show(particles, view)
# Points are drawn alike on any number of ranks; ParaView's spheres ("Point Gaussian") are cut where ranks' parts meet.
# vessel.py gathers what can be seen instead.
display.Representation = "Points"
display.PointSize = 3
ColorBy(display, ("POINTS", "damage"))
colours = GetColorTransferFunction("damage")
colours.AutomaticRescaleRangeMode = "Never"
colours.RescaleTransferFunction(0.0, 0.5)

view.CameraPosition = [3.0, 1.0, 1.5]  # the direction to look from; ResetCamera finds the distance
view.CameraFocalPoint = [0.0, 0.0, 0.0]
view.CameraViewUp = [0.0, 0.0, 1.0]
ResetCamera(view)

# One image every time that the program offers data (2: at every even step number, and so on). Files of extractors go to
# the run's folder of images; a name that would lead out of it, or that two extractors share, is refused before the run.
image = CreateExtractor("PNG", view, registrationName="image")
image.Writer.FileName = "damage_{timestep:06d}.png"
image.Writer.ImageResolution = [800, 600]
image.Trigger = "TimeStep"
image.Trigger.Frequency = 1

options = catalyst.Options()


def catalyst_execute(info):
    """Optional: called at every step, on every rank, before the extractors: to change the pipeline or to compute.

    What Python reads here of the data is this rank's part. An exception ends the run, on all ranks.
    """
    view.OrientationAxesVisibility = 1 if info.timestep == 0 else 0
