"""Valid cases that hold every key there is, and the small files that they name."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np

import treadload

_ROOT = Path(__file__).parents[2]
_FILES = [
    *sorted((_ROOT / "examples").rglob("*.toml")),
    *sorted((Path(treadload.__file__).parent / "demo").glob("*.toml")),
]

_TIRE = """
[tire]
profile = "315/80R22.5"
inflation_pressure = "8.2 bar"
"""
_LAYER = """
[[pavement.layers]]
material = { modulus = "5400 MPa", poisson = 0.35 }
"""
_ROLLING = """
[rolling]
normal_load = "32.5 kN"
friction = 0.7
"""

_TREADS = """
title = "a tread of its own"
spacing = "6 mm"
tolerance = 1e-6
road_compliance = "layers"

[tire]
inflation_pressure = "8.2 bar"
material = { kind = "prony", modulus = "10 MPa", terms = [[0.3, "1 ms"], [0.4, "20 ms"]], poisson = 0.49 }

[tire.profile]
rolling_radius = 0.5
crown_radius = 1.2
width = 0.2
shoulder_radius = 0.01
name = "lugs"
grooves = [{ centre = 0.0, width = 0.01, depth = 0.01, wall_angle = 0.1, edge_radius = 0.001, tie_bar = 0.002 }]
lateral = [
    { pitch = 0.08, width = 0.02, depth = 0.01, angle = 0.3, y_range = [-0.1, -0.02], offset = 0.01 },
    { pitch = 0.08, width = 0.02, depth = 0.01, angle = -0.3, y_range = [0.02, 0.1] },
]

[pavement]
temperature = [15, 15]
rigid_base = true
extrapolate = true

[[pavement.layers]]
thickness = "80 mm"
bond = { stiffness = "1000 MPa/m" }
[pavement.layers.material]
kind = "prony"
modulus = "10 GPa"
terms = [[0.7, "10 ms"]]
poisson = 0.35
shift = { kind = "wlf", c1 = 15, c2 = "120 K", reference = 15, tested = [0, 40] }

[[pavement.layers]]
thickness = "200 mm"
[pavement.layers.material]
kind = "power-law-creep"
instantaneous_compliance = "2.5e-5 1/MPa"
long_term_compliance = 1e-8
tau = 1000
exponent = 0.35
poisson = 0.3
shift = { kind = "arrhenius", activation_energy = "200 kJ/mol", reference = 15 }

[rolling]
approach = "10 mm"
creepage_x = -0.01
creepage_y = 0.001
spin = "0.05 1/m"
speed = "70 km/h"
friction = 0.6

[response]
depths = ["0 mm", "80 mm"]
side = "below"
speed = 20
wheels = [{ x = "0 mm", y = "-170 mm" }, { y = "170 mm", mirror = true }]
"""

_ASPHALT = f"""
{_TIRE}
[pavement]
temperature = {{ depths = ["0 mm", "200 mm"], values = [25, 20] }}
frequency = "10 Hz"

[[pavement.layers]]
thickness = "40 mm"
bond = "half-bonded"
material = {{ kind = "published", name = "ViscoRoute" }}

[[pavement.layers]]
thickness = "60 mm"
mix = "EB-BBSG3"
bond = "frictionless"

[[pavement.layers]]
thickness = "100 mm"
[pavement.layers.material]
kind = "2s2p1d"
glassy_modulus = "40 GPa"
static_modulus = "18 MPa"
delta = 2.3
k = 0.2
h = 0.5
beta = 300
tau = "10 ms"
poisson = 0.35
shift = {{ kind = "table", temperatures = [0, 15, 30], log_factors = [2.1, 0, -1.8], reference = 15 }}

[[pavement.layers]]
mix = "PF3"
{_ROLLING}
speed = "70 km/h"
lateral_force = "2 kN"
"""

_FRICTION = (
    '{ law = "coulomb", coefficient = 0.7 }',
    '{ law = "exponential", static = 0.9, kinetic = 0.5, reference_speed = "2 m/s" }',
    '{ law = "rational", static = 0.9, kinetic = 0.5, reference_speed = "2 m/s" }',
    '{ law = "pressure", reference = 0.8, reference_pressure = "700 kPa", exponent = 0.15, upper = 1.2 }',
    '{ law = "anisotropic", along = 0.8, across = 0.6, base = { law = "coulomb", coefficient = 0.7 } }',
    '{ law = "map", file = "wet.npy", cell = "100 mm", base = 0.8 }',
    '{ law = "flash", base = { law = "linear", static = 0.9, kinetic = 0.5, reference_speed = 2 }, '
    "tire = { conductivity = 0.25, heat_capacity = 2e6 }, road = { conductivity = 1.5, heat_capacity = 2e6 }, "
    'onset = "50 K", span = "90 K", hot = 0.5 }',
)
_LAWS = [
    f'{_TIRE}{_LAYER}[rolling]\nnormal_load = "32.5 kN"\nspeed = "50 km/h"\nfriction = {law}\n' for law in _FRICTION
]

_FOOTPRINT = f"""
[footprint]
file = "footprint.csv"
units = {{ pressure = "kPa" }}
spacing = ["5 mm", "5 mm"]
missing = "zero"
noise = "10 kPa"
shear_on = "tire"
interpolation = "bilinear"
{_LAYER}
[response]
depths = [0, 0.02]
[damage]
fatigue = {{ epsilon_6 = "120 microstrain", slope = -0.2 }}
strain = "in-plane"
depth = "20 mm"
"""
_MAP = (
    f'[tire]\nheight_map = "gap.csv"\ncell = "5 mm"\nmaterial = {{ modulus = "3 MPa", poisson = 0.5 }}\n'
    f"{_LAYER}{_ROLLING}"
)
_SCAN = (
    '[tire]\nscan = "example"\nunits = "m"\nnominal_diameter = "1.05 m"\nrotation = "2 deg"\ncamber = "1 deg"\n'
    f'revolve = false\nfill_holes = "auto"\ninflation_pressure = "8 bar"\n{_LAYER}{_ROLLING}'
)

_DESIGN = """
tolerance = 5e-3
tire = { profile = "315/80R22.5" }

[[pavement.layers]]
mix = "EB-BBSG3"
thickness = "60 mm"
[[pavement.layers]]
name = "base"
mix = "GC-T4"
thickness = "200 mm"
[[pavement.layers]]
name = "soil"
material = { modulus = "60 MPa", poisson = 0.35 }

[climate]
seasons = [
    { name = "cold", share = 0.5, temperature = [5, 8, 10] },
    { name = "warm", share = 0.5, temperature = [25, 20, 15] },
]

[traffic]
passes_per_year = 1e5
growth = 0.02
kind = "arithmetic"
years = 20
wander = { offsets = ["-100 mm", "0 mm", "100 mm"], shares = [0.25, 0.5, 0.25] }

[[traffic.classes]]
name = "single wheels"
share = 0.6
wheel_load = "32.5 kN"
inflation_pressure = "8 bar"
wheels = [["0 mm", "-0.17 m"], ["0 mm", "0.17 m"]]
maneuver = { kind = "uphill", grade = 0.06, driven_share = 0.4 }
friction = { law = "coulomb", coefficient = 0.7 }

[[traffic.classes]]
name = "tandem"
share = 0.3
axle_load = "113 kN"
inflation_pressure = "8 bar"
gear = "tandem-dual"
dual_spacing = "35 cm"
wheelbase = "1.35 m"
friction = 0.6
speed = "50 km/h"
maneuvers = [
    { kind = "forces", name = "push", tractive = 0.2, lateral = 0.1, spin = "0.01 1/m", share = 0.8 },
    { kind = "locked", share = 0.1 },
    { kind = "straight", share = 0.1 },
]

[[traffic.classes]]
name = "turning"
share = 0.1
wheel_load = "32.5 kN"
inflation_pressure = "8 bar"
[traffic.classes.maneuver]
kind = "turning"
radius = "-60 m"
speed = "36 km/h"
crossfall = 0.02
track = "2 m"
centre_of_gravity = 1.2
wheel = "inner"

[[criteria]]
name = "surface"
law = "mepdg-top-down"
layer = 1
air_voids = 0.07
binder_volume = 0.11
[[criteria]]
name = "fatigue"
law = "shell"
layer = 1
[[criteria]]
name = "base"
law = "french-hydraulic"
layer = "base"
risk = 0.05
platform_modulus = "60 MPa"
sigma_6 = "0.7 MPa"
slope = -0.0667
scatter = 1.0
calibration = 1.4
joints = 1.0
thickness_scatter = "30 mm"
[[criteria]]
name = "asphalt institute"
law = "asphalt-institute"
layer = 1
air_voids = 0.05
binder_volume = 0.11
[[criteria]]
name = "soil"
law = "asphalt-institute-subgrade"
[[criteria]]
name = "platform"
law = "french-subgrade"
constant = 0.012
slope = -0.222
"""

QUESTIONS: list[str] = [
    *(path.read_text(encoding="utf-8") for path in _FILES),
    _TREADS,
    _ASPHALT,
    *_LAWS,
    _FOOTPRINT,
    _MAP,
    _SCAN,
    _DESIGN,
]
"""Texts of cases; those with criteria are cases of design."""


def _npy(values: list[list[float]]) -> bytes:
    out = io.BytesIO()
    np.save(out, np.array(values))
    return out.getvalue()


TABLES: dict[str, bytes] = {
    "footprint.csv": b"100, 200, 100\n300, , 300\n100, 200, -5\n",
    "gap.csv": b"0.001, 0.0, 0.001\n0.002, 0.001, 0.002\n",
    "wet.npy": _npy([[0.5, 0.6], [0.7, 0.8]]),
}
"""Files that the cases name."""
