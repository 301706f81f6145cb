"""Catalyst script: the vessel at every output step, displacement beside damage, as vessel_<step>.png."""

import os

from paraview import catalyst
from paraview.simple import PVTrivialProducer

from vessel_picture import VesselPicture, field_value

fields = ["displacement", "damage"]  # the program computes and sends no others

options = catalyst.Options()
particles = PVTrivialProducer(registrationName="particles")
picture = VesselPicture(particles)


def catalyst_execute(info):
    # The program sets this directory: the run's folder of images.
    path = os.path.join(options.ExtractsOutputDirectory, f"vessel_{info.timestep:06d}.png")
    picture.save(path, info.timestep, info.time, field_value(particles, "pressure"))
