# SPDX-License-Identifier: BSD-3-Clause
"""Catalyst script: the vessel at every output step, displacement beside damage, as vessel_<step>.png.

Unlike template.py it does without paraview.simple, which takes half a second to load: see vessel_picture.py.
"""

import os

from paraview.modules.vtkPVPythonCatalyst import vtkCPPythonScriptV2Helper

from picture_tools import field_value
from vessel_picture import VesselPicture

fields = ["displacement", "damage"]  # the program computes and sends no others
image_directory = ""  # the program puts the run's folder of images here
producer = vtkCPPythonScriptV2Helper.GetActiveInstance().GetTrivialProducer("particles").GetClientSideObject()
picture = None


def catalyst_execute(info):
    global picture
    particles = producer.GetOutputDataObject(0)
    if picture is None:
        picture = VesselPicture(particles)
    path = os.path.join(image_directory, f"vessel_{info.timestep:06d}.png")
    picture.save(path, particles, info.timestep, info.time, field_value(particles, "pressure"))
