"""Catalyst script: the vessel at every output step, displacement beside damage, as vessel_<step>.png."""

from paraview import catalyst
from paraview.simple import CreateExtractor, PVTrivialProducer

from vessel_picture import HEIGHT, WIDTH, VesselPicture, field_value

fields = ["displacement", "damage"]  # the program computes and sends no others

options = catalyst.Options()
particles = PVTrivialProducer(registrationName="particles")
picture = VesselPicture(particles)

images = CreateExtractor("PNG", picture.view, registrationName="vessel")
images.Writer.FileName = "vessel_{timestep:06d}.png"
images.Writer.ImageResolution = [WIDTH, HEIGHT]


def catalyst_execute(info):
    picture.update(info.timestep, info.time, field_value(particles, "pressure"))
