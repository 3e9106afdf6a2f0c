"""
After which distance does a wheel roll steadily?
================================================

From rest with 3 % of slip: particles that enter the contact stick and are stretched on their way through it.
"""

import numpy as np

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
driving = tl.Rolling(normal_load=32.5e3, friction=0.7, creepage_x=-0.03)
start = tl.contact.solve_transient(tire, road, driving, distances=0.024 * np.arange(1, 31), spacing=12e-3)

figure = start.plot.history()

# %%
# Distance at which half of the final tractive force is reached:

force = start.dataset.tractive_force.to_numpy()
half = float(np.interp(0.5 * force[-1], force, start.dataset.distance.to_numpy()))
print(f"{1e3 * half:.0f} mm")
