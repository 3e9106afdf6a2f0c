"""
What a uniform disc misses
==========================

The real contact and the disc of conventional design, same load and area, on the same road.
"""

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=32.5e3, friction=0.7), spacing=12e-3)
compared = tl.damage.compare_uniform(contact, road)
print(compared)

figure = compared.plot.strains()
