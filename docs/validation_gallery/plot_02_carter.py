"""
Rolling: shear of a strip against Carter
========================================

A cylinder that transmits 0.64 of its friction, 200 cells across the contact. Witness: Carter's closed form.
"""

import numpy as np

import treadload as tl
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.closed_forms import carter_shear, carter_stick
from treadload.validation.patches import LONG, cylinder

bodies = CombinedElasticity(1.0, 0.28, 0.0)
radius, friction, number = 100.0, 0.3, 200
peak = bodies.contact_modulus / (2 * radius)
creepage = -0.4 * friction / radius
patch = cylinder(bodies, radius, np.pi * peak / 2, number + 6, 2 / number, LONG)
shear = patch.roll(friction, (creepage, 0.0), tolerance=1e-9).shear[0, 0] / (friction * peak)
closed = carter_shear(patch.x, carter_stick(creepage, radius, 1.0, friction))

figure = tl.plots.new_figure(7, 3.6)
axes = figure.subplots()
axes.plot(patch.x, shear, label="treadload")
axes.plot(patch.x[::4], closed[::4], "o", markersize=3.5, label="Carter (1926)")
axes.plot(patch.x, np.sqrt(np.clip(1 - patch.x**2, 0, None)), ":", color="0.5", label="friction bound")
axes.set(xlabel="x over the half-width; travel to the right", ylabel="shear over μp₀")
axes.legend(frameon=False)

# %%
# Largest deviation, over μp₀:

deviation = float(np.abs(shear - closed).max())
print(f"{deviation:.4f}")
