# SPDX-License-Identifier: BSD-3-Clause
"""Catalyst script: the vessel cut open at every output step, hoop stress beside hoop stretch, as
stress_<step>.png; for material.law = "neo_hookean" or "fibre_reinforced".

Without paraview.simple, as vessel.py.
"""

import os

from paraview.modules.vtkPVPythonCatalyst import vtkCPPythonScriptV2Helper

from picture_tools import field_value
from vessel_picture import Shown, VesselPicture

fields = ["displacement", "damage", "hoop_stress", "hoop_stretch"]  # the program computes and sends no others
image_directory = ""  # the program puts the run's folder of images here
producer = vtkCPPythonScriptV2Helper.GetActiveInstance().GetTrivialProducer("particles").GetClientSideObject()
shown = (
    Shown("hoop_stress", "Hoop stress (kPa)", 1e-3, whole_wall_only=True),
    Shown("hoop_stretch", "Hoop stretch", bottom=1.0, whole_wall_only=True),
)
picture = None


def catalyst_execute(info):
    global picture
    particles = producer.GetOutputDataObject(0)
    if picture is None:
        picture = VesselPicture(particles, shown, cut_open=True)
    path = os.path.join(image_directory, f"stress_{info.timestep:06d}.png")
    picture.save(path, particles, info.timestep, info.time, field_value(particles, "pressure"))
