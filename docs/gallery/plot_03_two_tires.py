"""
One tread, two tires
====================

The same tread under the same load as a half-space of rubber, and on a belt inflated to 820 kPa.
"""

import treadload as tl

road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
wheel = tl.Rolling(normal_load=35e3, friction=0.7)
tires = {
    "half-space": tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3),
    "belt": tl.Tire.from_profile(
        "315/80R22.5", inflation_pressure=820e3, belt=tl.tire.Belt.from_library("315/80R22.5")
    ),
}
contacts = [tl.solve_contact(tire, road, wheel, spacing=8e-3) for tire in tires.values()]

figure = tl.plots.compare_pressure(contacts, list(tires))
