"""
What does a sphere leave in a half-space that yields?
=====================================================

A rigid sphere pressed to three times the load of first yield and lifted again: a dent stays.
"""

import numpy as np

import treadload as tl

soft = tl.materials.ElastoPlastic(tl.Elastic(1e9, 0.3), tl.materials.VonMises(2e6, hardening=1e6))
road = tl.Pavement.half_space(soft)
cell = 0.12e-3
across = cell * (np.arange(24) - 11.5)
ball = tl.Tire.from_height_map((across[None] ** 2 + across[:, None] ** 2) / 0.2, cell, material=tl.Elastic(1e15, 0.3))
load = 4.33
pressed = tl.contact.solve_indentation(ball, road, [load, 0.0], depth=2.5e-3, layers=10)

figure = pressed.plot.dent()

# %%
# Depth of the dent that is left, over the approach under load:

dent = float(pressed.dataset.residual_displacement_z[-1].max() / pressed.dataset.approach[0])
print(f"{dent:.3f}")
