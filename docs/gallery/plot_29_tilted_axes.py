"""
Where does a wheel on a slope press?
====================================

A steel ball on a laminate whose fibres dive into it by 20 degrees: the contact is an ellipse although both bodies are
round and flat.
"""

import numpy as np

import treadload as tl

laminate = tl.materials.Orthotropic((130e9, 10e9, 10e9), (5e9, 5e9, 3.5e9), (0.3, 0.3, 0.4))
road = tl.Pavement.half_space(laminate.rotated(yaw=np.radians(40), pitch=-np.radians(20)))
cell = 0.2e-3
across = cell * (np.arange(36) - 17.5)
ball = tl.Tire.from_height_map(
    (across[None] ** 2 + across[:, None] ** 2) / 0.2, cell, material=tl.Elastic(210e9, 0.3)
)
contact = tl.solve_contact(ball, road, tl.Rolling(normal_load=3e3, friction=0.0))

figure = contact.plot.pressure()

# %%
# Axes of the ellipse, from the second moments of the pressure:

pressure = contact.dataset.pressure.to_numpy()
x, y = np.meshgrid(contact.dataset.x, contact.dataset.y)
moments = np.cov(np.stack([x.ravel(), y.ravel()]), aweights=pressure.ravel())
ratio = float(np.sqrt(np.linalg.cond(moments)))
print(f"long over short axis: {ratio:.3f}")
