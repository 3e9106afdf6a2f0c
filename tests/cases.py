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
