"""
Asphalt over frequency
======================

A published Huet-Sayegh mix as a master curve, and in the Cole-Cole plane.
"""

import treadload as tl

mix = tl.catalogue.materials["ViscoRoute"].material
print(mix)
temperatures = [0, 15, 30]
models, labels = [mix.at(t) for t in temperatures], [f"{t} °C" for t in temperatures]

curve = tl.plots.master_curve(models, labels, frequencies=(1e-4, 1e4))

# %%
# Loss against storage modulus: one curve for all temperatures.

plane = tl.plots.cole_cole(models[1])
