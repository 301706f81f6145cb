# SPDX-License-Identifier: BSD-3-Clause
"""Tiny scenes of every kind: what a mutation starts from. A run of any takes some tenths of a second.

A scene is a mapping of file names to texts; the input file is called scene.toml.
"""

import base64
import pathlib
import struct
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/cli"))
sys.argv.append("unused")  # the helpers of tests read the program's name from there

from coupled_case import JUNCTIONS, TWO_WAY, VESSELS, changed  # noqa: E402

sys.argv.pop()

# 96 columns x 15 rows, 20 steps.
VESSEL = """\
[vessel]
inner_radius = "1.5 mm"
outer_radius = "2 mm"
length = "3.5 mm"

[material]
density = "1.3 g/cm3"
young_modulus = "3.5 MPa"
critical_stretch = 0.1

[discretisation]
spacing = "250 um"
horizon_ratio = 2.2

[load]
pressure = "600 kPa"
schedule = "ramp"
ramp_time = "0.1 ms"

[time]
step = "2 us"
end = "40 us"

[output]
every_steps = 5
checkpoint_every = 10
movie = false
"""

HEART_BEAT = """\
[[spot]]
position = "1 mm"
angle = "22 deg"
radius = "1 mm"
thickness = 0.5

[[spot]]
position = "2.5 mm"
angle = "180 deg"
radius = "1 mm"
critical_stretch = 0.6

[scatter]
critical_stretch = 0.03
stiffness = 0.03
seed = 7

"""

TABLE = 'schedule = "table"\ntable = [["0 ms", "80 mmHg"], ["10 us", "300 kPa"], ["0.02 ms", "1.2e5 Pa"], ["0.1 ms", "80 mmHg"]]'

TREE = """\
[tree]
generations = 6
root_radius = "2 mm"
terminal_radius = "0.3 mm"
asymmetry = 0.9
least_asymmetry = 0.5
length_spread = 0.2
seed = 3
length_ratio_by_generation = [12, 13, 14, 15.1, 16.3, 17.6]

[wall]
artery_rule = "radius"
vein_rule = "ratio"
vein_ratio = 0.1

[blood]
viscosity_law = "in_vivo"
haematocrit = 0.45

[flow]
inlet_pressure = "95 mmHg"
outlet_pressure = "3 mmHg"
acceleration = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]

"""

ENSEMBLE = """\
[scene]
model = "ensemble"

[ensemble]
lowest_pressure = "105 mmHg"
highest_pressure = "240 mmHg"
pressure_count = 2
samples = 3
strength_spread = 0.12
thickness_spread = 0.07

[vessel]
inner_radius = "1.5 mm"
outer_radius = "2 mm"
length = "2.5 mm"

[material]
critical_stretch = 0.025

[discretisation]
spacing = "250 um"
horizon_ratio = 2.2

[boundary]
ends = "axial_periodic"

[load]
schedule = "smooth_ramp"
ramp_time = "0.1 ms"

[time]
end = "0.1 ms"
"""

# Two capillaries side by side between an arteriole and a venule.
CSV_JUNCTIONS = """\
id,x [mm],y [mm],z [mm],pressure [mmHg],flow [mL/s],resistance [Pa s/m3]
in,0,0,0,60,,
a,1,0,0,,,
b,2,0.5,0,,,
"out, 1",3,0,0,20,,1e9
out 2,3,1,0,,-1e-6,
"""
CSV_VESSELS = """\
id,from,to,radius [um],length [mm],wall_thickness [um],kind,generation
arteriole,in,a,20,1,4,artery,0
left,a,b,5,1.2,1,,1
right,a,b,4,,1,,1
venule,b,"out, 1",25,1,2,vein,0
stub,b,out 2,6,1,1,,
"""
JSON_NETWORK = """\
{"units": {"length": "mm", "pressure": "mmHg", "flow": "mL/s", "resistance": "Pa s/m3"},
 "junctions": [
  {"id": "in", "x": 0, "y": 0, "z": 0, "pressure": 60},
  {"id": "a", "x": 1, "y": 0, "z": 0},
  {"id": 7, "x": 2, "y": 0.5, "z": 0},
  {"id": "out", "x": 3, "y": 0, "z": 0, "pressure": 20, "resistance": 1e9}],
 "vessels": [
  {"id": "arteriole", "from": "in", "to": "a", "radius": 0.02, "length": 1, "wall_thickness": 0.004, "kind": "artery", "generation": 0},
  {"id": "left", "from": "a", "to": 7, "diameter": 0.01, "length": 1.2},
  {"id": "right", "from": "a", "to": 7, "radius": 0.004, "length": null},
  {"id": "venule", "from": 7, "to": "out", "radius": 0.025, "kind": "vein"}]}
"""


def network(files, more=""):
    names = ", ".join(f'"{name}"' for name in files)
    return f'[scene]\nmodel = "network"\n\n[network]\nsource = "file"\nfiles = [{names}]\n{more}\n[screening]\ntop = 2\n'


def vtp_network():
    """A centre line that forks, as VMTK writes it: two lines of three points, in ASCII and inline base64."""

    def inline(name, kind, values, code, more=""):
        data = struct.pack(f"<{len(values)}{code}", *values)
        text = base64.b64encode(struct.pack("<I", len(data)) + data).decode()
        return f'<DataArray type="{kind}" Name="{name}"{more} format="binary">{text}</DataArray>'

    nan = float("nan")
    points = "0 0 0  1 0 0  2 0.5 0  1 0 0  2 -0.5 0  3 -0.5 0"
    return f"""\
<?xml version="1.0"?>
<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian" header_type="UInt32">
<PolyData><Piece NumberOfPoints="6" NumberOfVerts="0" NumberOfLines="2" NumberOfStrips="0" NumberOfPolys="0">
<PointData>
{inline("MaximumInscribedSphereRadius", "Float64", (0.3, 0.28, 0.2, 0.28, 0.22, 0.2), "d")}
{inline("pressure_condition", "Float64", (8000, nan, 2000, nan, nan, 2500), "d")}
</PointData><CellData></CellData>
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">{points}</DataArray></Points>
<Lines><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 4 5</DataArray>
{inline("offsets", "Int64", (3, 6), "q")}</Lines>
</Piece></PolyData></VTKFile>
"""


def replaced(text, **lines):
    """`text` with other lines for those of these keys."""
    for key, new in lines.items():
        text = changed(text, key, new)
    return text


def with_checkpoints(files, every, **lines):
    """`files` of a scene that leaves a checkpoint every so many steps, with other lines for those of these keys."""
    text = replaced(files["scene.toml"], **lines)
    old = [line for line in text.splitlines() if line.startswith("checkpoint_every")]
    text = text.replace(old[0] + "\n", "") if old else text
    return {**files, "scene.toml": text.replace("[output]", f"[output]\ncheckpoint_every = {every}")}


def coupled(text, more=""):
    brief = replaced(text, critical_stretch="critical_stretch = 0.02", ramp_time='ramp_time = "0.1 ms"', end='end = "0.1 ms"')
    return {"scene.toml": brief + more, "j.csv": JUNCTIONS, "v.csv": VESSELS}


def all_scenes():
    """By name; every one is a valid input."""
    one_way = changed(TWO_WAY, "mode", "").replace('window = "20 us"', "")
    two_way = TWO_WAY.replace('every_steps = 4', 'every_steps = 10')
    cascade = two_way.replace("[material]", '[cascade]\nevents = 2\noutcome = "occlusion"\nrisk_limit = 0.5\n\n[material]')
    csv = {"j.csv": CSV_JUNCTIONS, "v.csv": CSV_VESSELS}
    haematocrit = '\n[blood]\nviscosity_law = "in_vivo"\nhaematocrit = 0.4\nphase_separation = true\n'
    tree_model = '[scene]\nmodel = "network"\n\n'
    weak = '[screening]\ntop = 3\n\n[weakness]\nvessels = ["artery.01"]\nstrength = 0.2\n'
    vtp = network(["n.vtp"], 'file_length_unit = "mm"\n')
    return {
        "vessel": {"scene.toml": VESSEL},
        "vessel.table": {"scene.toml": replaced(VESSEL, schedule=TABLE, pressure="", ramp_time="") + HEART_BEAT},
        "vessel.lps": {"scene.toml": replaced(VESSEL, young_modulus='law = "lps"\npoisson_ratio = 0.4')},
        "vessel.fung": {"scene.toml": replaced(VESSEL, young_modulus='law = "fung"\nfung_exponent = 3')},
        "vessel.lattice": {"scene.toml": replaced(VESSEL, spacing='spacing = "250 um"\ncross_section = "lattice"', pressure='pressure = "20 kPa"')
                           + '[start]\nequilibrium_pressure = "2 kPa"\n'},
        "tree": {"scene.toml": tree_model + TREE + weak},
        "tree.explicit": {"scene.toml": tree_model + TREE + '[network]\ntier = "explicit"\nquery = ["artery.010", "vein."]\n'},
        "csv": {"scene.toml": network(csv, 'query = ["left"]\n') + haematocrit, **csv},
        "json": {"scene.toml": network(["n.json"], 'query = ["left"]\n'), "n.json": JSON_NETWORK},
        "vtp": {"scene.toml": vtp, "n.vtp": vtp_network()},
        "one_way": coupled(one_way),
        "two_way": coupled(two_way),
        "cascade": coupled(cascade),
        "tree.two_way": {"scene.toml": tree_model.replace("network", "coupled") + TREE.replace("95 mmHg", "300 mmHg")
                         + '[coupling]\nvessel = "artery.0"\nmode = "two_way"\n\n[material]\ncritical_stretch = 0.02\n\n'
                           '[discretisation]\nspacing = "440 um"\nhorizon_ratio = 2.2\n\n[load]\nramp_time = "0.1 ms"\n\n[time]\nend = "0.1 ms"\n'},
        "ensemble": {"scene.toml": ENSEMBLE},
    }
