"""
Force against creepage
======================

Each point starts from the one before it; the slope at the origin is the slip stiffness of the tread.
"""

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
curves = [
    tl.contact.creep_curve(
        tire, road, tl.Rolling(normal_load=32.5e3, friction=friction),
        (-0.2, -0.1, -0.05, -0.02, 0.0, 0.02, 0.05, 0.1, 0.2), spacing=10e-3,
    )
    for friction in (0.7, 0.35)
]  # fmt: skip

figure = tl.plots.creep_curves(curves, ["dry, 0.7", "wet, 0.35"])
