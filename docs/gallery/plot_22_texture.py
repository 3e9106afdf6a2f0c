"""
How much of a rough surface touches the tire?
=============================================

Rubber pressed on a patch of 50 mm of a surface made from a spectrum, under 0.2 and 0.8 MPa.
"""

import treadload as tl
from treadload.pavement import texture

surface = texture.self_affine(0.05, 0.05 / 128, hurst=0.8, shortest=3.2e-3, roll_off=12e-3, rms_height=0.3e-3, seed=1)
pressed = tl.contact.solve_texture(surface, tl.Elastic(6e6, 0.5), [0.2e6, 0.8e6], thickness=0.015)

figure = pressed.plot.patch()

# %%
# Real area of contact over the nominal one, at both pressures:

shares = pressed.dataset.real_area_ratio.to_numpy()
print(shares.round(3))
