"""
Layers: stress over depth against ELLEA1
========================================

Vertical stress below the axis of a wheel on three layers. Witness: tables that ELLEA1 (Levenberg) printed.
"""

import numpy as np

import treadload as tl
from treadload.validation.layers import _ELLEA_DEPTHS, _ELLEA_STRESS

rows = zip((3000e6, 200e6, 40e6), (0.30, 0.35, 0.40), (0.15, 0.60, None), strict=True)
road = tl.Pavement([tl.Layer(tl.Elastic(modulus, poisson), thickness) for modulus, poisson, thickness in rows])
depths = np.array(_ELLEA_DEPTHS) / 1e3
wheel = tl.UniformDisc(0.15, 1.1e6)
computed, fine = (
    -1e-6 * tl.solve_response(wheel, road, depths=places, x=[0.0], y=[0.0]).dataset.stress_zz.squeeze()
    for places in (depths, np.linspace(0, 1, 101))
)

figure = tl.plots.new_figure(7, 4)
axes = figure.subplots()
axes.plot(fine, 1e3 * fine.depth, label="treadload")
axes.plot(_ELLEA_STRESS, 1e3 * depths, "o", markersize=4, label="ELLEA1, printed")
for interface in road.interfaces:
    axes.axhline(1e3 * interface, color="0.8", linewidth=0.8)
axes.set(xlabel="vertical stress (MPa), compression positive", ylabel="depth (mm)")
axes.invert_yaxis()
axes.legend(frameon=False)

# %%
# Largest deviation, MPa:

deviation = float(np.abs(computed - np.array(_ELLEA_STRESS)).max())
print(f"{deviation:.5f}")
