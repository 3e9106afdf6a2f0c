"""
Does a slow wheel strain asphalt more?
======================================

The same disc over viscoelastic asphalt at 1 and at 20 m/s: strain along travel at the bottom of 15 cm of a published
mix.
"""

import numpy as np

import treadload as tl

mix = tl.catalogue.materials["ViscoRoute"].material.at(25.0)  # °C
road = tl.Pavement([
    tl.Layer(mix, 0.15, name="asphalt"),
    tl.Layer(tl.Elastic(200e6, 0.35), 0.30, name="base"),
    tl.Layer(tl.Elastic(80e6, 0.35), name="subgrade"),
])  # fmt: skip
x = np.linspace(-1.0, 0.8, 73)
figure = tl.plots.new_figure(7.5, 3.6)
axes = figure.subplots()
peaks = {}
for speed in (1.0, 20.0):
    solved = tl.solve_response(tl.UniformDisc(0.125, 662e3), road, depths=[0.15], x=x, y=[0.0], speed=speed)
    strain = 1e6 * solved.dataset.strain_xx.squeeze()
    axes.plot(x, strain, label=f"{speed:g} m/s")
    peaks[speed] = float(strain.max())
axes.set(xlabel="point ahead of the load (m); travel to the right", ylabel="strain along travel (microstrain)")
axes.legend(frameon=False)

# %%
# The largest strain, at walking pace over that at 72 km/h:

slow = peaks[1.0] / peaks[20.0]
print(f"{peaks[1.0]:.0f} and {peaks[20.0]:.0f} microstrain: {slow:.2f} times")
