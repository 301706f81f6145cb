# SPDX-License-Identifier: BSD-3-Clause
"""Catalyst script: the network at every output step, arteries and veins beside pressures, as network_<step>.png.

Without paraview.simple, which takes half a second to load: see network_picture.py.
"""

import os

from paraview.modules.vtkPVPythonCatalyst import vtkCPPythonScriptV2Helper

from network_picture import NetworkPicture

network_fields = ["pressure", "flow", "radius", "kind"]  # the program computes and sends no others
image_directory = ""  # the program puts the run's folder of images here
producer = vtkCPPythonScriptV2Helper.GetActiveInstance().GetTrivialProducer("network").GetClientSideObject()
picture = NetworkPicture()


def catalyst_execute(info):
    path = os.path.join(image_directory, f"network_{info.timestep:06d}.png")
    picture.save(path, producer.GetOutputDataObject(0), info.time)
