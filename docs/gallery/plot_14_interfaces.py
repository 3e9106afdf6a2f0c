"""
What does a lost bond cost?
===========================

Dual wheels on a wearing course of 6 cm that is bonded, half-bonded or not bonded to its base.
"""

import numpy as np

import treadload as tl

wheels = tl.response.dual_wheels(tl.UniformDisc(0.125, 662e3), 0.375)
depths = np.linspace(0.0, 0.21, 43)
bonds = {
    "bonded": tl.pavement.BONDED,
    "half-bonded": tl.pavement.HALF_BONDED,
    "frictionless": tl.pavement.FRICTIONLESS,
}
figure = tl.plots.new_figure(7, 3.8)
axes = figure.subplots()
strains = {}
for name, bond in bonds.items():
    road = tl.Pavement([
        tl.Layer(tl.Elastic(7e9, 0.35), 0.06, bond=bond),
        tl.Layer(tl.Elastic(9e9, 0.35), 0.15),
        tl.Layer(tl.Elastic(120e6, 0.35)),
    ])  # fmt: skip
    line = tl.solve_response(wheels, road, depths=depths, x=[0.0], y=[0.1875]).dataset.squeeze()
    axes.plot(1e6 * line.strain_xx, 1e3 * depths, label=name)
    strains[name] = 1e6 * float(line.strain_xx.sel(depth=0.21))
axes.set(xlabel="strain along travel below a wheel (microstrain)", ylabel="depth (mm)")
axes.invert_yaxis()
axes.legend(frameon=False)

# %%
# Tensile strain at the bottom of the base:

for name, strain in strains.items():
    print(f"{name}: {strain:.1f} microstrain")
