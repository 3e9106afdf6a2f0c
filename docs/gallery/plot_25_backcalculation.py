"""
How well does a bowl determine moduli?
======================================

A bowl with 2 % of noise at each sensor, fitted without a start; bars show one standard deviation.
"""

import numpy as np

import treadload as tl

road = tl.Pavement(
    [
        tl.Layer(tl.Elastic(4e9, 0.35), 0.15, name="asphalt"),
        tl.Layer(tl.Elastic(300e6, 0.35), 0.30, name="base"),
        tl.Layer(tl.Elastic(70e6, 0.40), name="subgrade"),
    ]
)
offsets = np.array([0, 0.2, 0.3, 0.45, 0.6, 0.9, 1.2, 1.5, 1.8])
plate = tl.UniformDisc(0.15, 50e3 / (np.pi * 0.15**2))
bowl = tl.solve_response([plate], road, depths=[0.0], x=offsets, y=[0.0])
down = bowl.dataset.displacement_z.to_numpy().ravel()
noise = np.random.default_rng(6).standard_normal((4, down.size))
stations = tuple(f"km 1.{k}" for k in range(4))
basins = tl.roads.Basins(down * (1 + 0.02 * noise), offsets, np.full(4, 50e3), 0.15, station=stations)
fitted = tl.backcalculate(basins, road, stiff_layer=None, error="2 %")

figure = fitted.plot.moduli()

# %%
# Subgrade modulus, mean of the four bowls; 70 MPa were put in:

subgrade = 1e-6 * float(fitted.dataset.fitted_modulus.sel(layer_name="subgrade").mean())
print(f"{subgrade:.1f} MPa")
