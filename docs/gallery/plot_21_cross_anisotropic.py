"""
Does it matter that asphalt is stiffer along than down?
=======================================================

A compacted layer with a vertical modulus of half the horizontal one, below dual wheels.
"""

import numpy as np

import treadload as tl

wheels = tl.response.dual_wheels(tl.UniformDisc(0.125, 662e3), 0.375)
depths = np.linspace(0.0, 0.20, 41)
materials = {
    "isotropic, 6 GPa": tl.Elastic(6e9, 0.35),
    "3 GPa down, 6 GPa along": tl.materials.TransverselyIsotropic(
        horizontal=6e9, vertical=3e9, shear=1.6e9, poisson_horizontal=0.35, poisson_vertical=0.30
    ),
}
figure = tl.plots.new_figure(7, 3.8)
axes = figure.subplots()
strains = {}
for name, material in materials.items():
    road = tl.Pavement([tl.Layer(material, 0.20), tl.Layer(tl.Elastic(100e6, 0.35))])
    line = tl.solve_response(wheels, road, depths=depths, x=[0.0], y=[0.1875]).dataset.squeeze()
    axes.plot(1e6 * line.strain_xx, 1e3 * depths, label=name)
    strains[name] = 1e6 * float(line.strain_xx[-1])
axes.set(xlabel="strain along travel below a wheel (microstrain)", ylabel="depth (mm)")
axes.invert_yaxis()
axes.legend(frameon=False)

# %%
# Change of the tensile strain at the bottom:

isotropic, anisotropic = strains.values()
change = anisotropic / isotropic - 1
print(f"{change:+.1%}")
