"""
Contact: pressure of a sphere against Hertz
===========================================

A sphere of 10 m of rubber on asphalt, cells of a thirtieth of the contact. Witness: Hertz's closed form.
"""

import numpy as np

import treadload as tl
from treadload.validation.closed_forms import hertz

rubber, asphalt = tl.Elastic(3e6, 0.5), tl.Elastic(5.4e9, 0.35)
modulus = 1 / sum((1 - body.poisson**2) / body.modulus for body in (rubber, asphalt))
exact = hertz(1.0, 1.0, 2e3, modulus)
cell = 2 * exact.a / 60
across = cell * (np.arange(70) - 34.5)
ball = tl.Tire.from_height_map((across[None] ** 2 + across[:, None] ** 2) / 2, cell, material=rubber)
contact = tl.solve_contact(ball, tl.Pavement.half_space(asphalt), tl.Rolling(normal_load=2e3, friction=0.0))
line = contact.dataset.pressure.sel(y=0.0, method="nearest") / 1e3
r = np.hypot(line.x, float(line.y))
closed = exact.peak / 1e3 * np.sqrt(np.clip(1 - (r / exact.a) ** 2, 0, None))

figure = tl.plots.new_figure(7, 3.6)
axes = figure.subplots()
axes.plot(1e3 * line.x, line, label="treadload")
axes.plot(1e3 * line.x, closed, "o", markersize=3.5, label="Hertz (1882)")
axes.set(xlabel="x (mm)", ylabel="pressure (kPa)")
axes.legend(frameon=False)

# %%
# Deviation of the peak pressure:

deviation = float(contact.dataset.pressure.max()) / exact.peak - 1
print(f"{deviation:+.2%}")
