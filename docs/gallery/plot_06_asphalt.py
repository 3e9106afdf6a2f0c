"""
Asphalt over frequency
======================

A published Huet-Sayegh mix as a master curve, and in the Cole-Cole plane.
"""

import treadload as tl

published = tl.catalogue.materials
name = next(iter(published))
mix = published[name].material
print(name, mix)

curve = tl.plots.master_curve([mix], [name])

# %%
# Loss against storage modulus: what a model does to the stiff side.

plane = tl.plots.cole_cole([mix], [name])
