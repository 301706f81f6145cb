# SPDX-License-Identifier: BSD-3-Clause
"""Catalyst script: a network above the vessel of it whose wall is simulated, as coupled_<step>.png.

A ring marks the vessel in the network. The views are those of network.py and vessel.py.
"""

import os

import numpy
from paraview.modules.vtkPVPythonCatalyst import vtkCPPythonScriptV2Helper

from network_picture import NetworkPicture
from picture_tools import field_value, write_png
from vessel_picture import VesselPicture

fields = ["displacement", "damage"]  # the program computes and sends no others
network_fields = ["pressure", "flow", "radius", "kind"]
image_directory = ""  # the program puts the run's folder of images here
helper = vtkCPPythonScriptV2Helper.GetActiveInstance()
particle_producer = helper.GetTrivialProducer("particles").GetClientSideObject()
network_producer = helper.GetTrivialProducer("network").GetClientSideObject()
network_picture = NetworkPicture()
vessel_picture = None
shown_event = None  # of a cascade; every one is another vessel


def catalyst_execute(info):
    global vessel_picture, shown_event
    particles, network = particle_producer.GetOutputDataObject(0), network_producer.GetOutputDataObject(0)
    event = field_value(network, "event")
    if event != shown_event:
        vessel_picture, shown_event = VesselPicture(particles), event
    above = network_picture.rows(network, info.time)
    leak = field_value(network, "leak")
    note = f"      event {event:.0f}" if event else ""
    note += f"      leak = {6e7 * leak:.3g} mL/min" if leak else ""
    below = vessel_picture.rows(particles, info.timestep, info.time, field_value(particles, "pressure"), note)
    if above is not None:
        write_png(os.path.join(image_directory, f"coupled_{info.timestep:06d}.png"), numpy.concatenate([above, below]))
