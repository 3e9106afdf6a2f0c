"""Small cases that several tests share."""

COARSE_CASE = """
title   = "coarse"
spacing = "12 mm"

[tire]
profile = "315/80R22.5"
inflation_pressure = "8.2 bar"

[[pavement.layers]]
name = "asphalt concrete"
material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }

[rolling]
normal_load    = "32.5 kN"
tractive_force = "10 kN"
friction       = 0.7

[response]
depths = ["0 mm", "20 mm"]

[damage]
fatigue = { epsilon_6 = "120 microstrain", slope = -0.2 }
"""

# The life of a road under one axle, up to its criteria.
ONE_AXLE = """
spacing = "20 mm"
tire = { profile = "315/80R22.5" }
pavement = { structure = "6 BBSG3 / 15 GB3 / PF3" }
climate = { temperature = 15 }
[traffic]
passes_per_year = 1e5
[[traffic.classes]]
name = "axle"
share = 1
axle_load = "100 kN"
inflation_pressure = "8 bar"
"""

# What a life of that structure reads: its base and its soil.
BASE_AND_SOIL = """
[[criteria]]
name = "base"
law = "french-bituminous"
layer = "EB-GB3"
risk = 0.05
[[criteria]]
name = "soil"
law = "french-subgrade"
"""


def belted_truck(spacing: str, friction: float) -> str:
    """A truck tire on its belt under 20 kN, on asphalt as a half-space."""
    return f"""
spacing = "{spacing}"
[tire]
profile = "315/80R22.5"
inflation_pressure = "8 bar"
belt = "315/80R22.5"
[[pavement.layers]]
material = {{ kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }}
[rolling]
normal_load = "20 kN"
friction = {friction}
"""
