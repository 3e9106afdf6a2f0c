"""
What torque turns a standing wheel?
===================================

A wheel under 32.5 kN is turned by 30 degrees: the tread twists, then slides from its ends inwards.
"""

import numpy as np

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
standing = tl.Rolling(normal_load=32.5e3, friction=0.7)
angles = np.radians(np.linspace(2.5, 30, 12))
turn = tl.contact.turn_on_the_spot(tire, road, standing, angles=angles, spacing=12e-3)

figure = turn.plot.history()

# %%
# At 30 degrees nearly all of it slides:

share = float(turn.dataset.steering_torque[-1] / turn.dataset.sliding_torque)
print(f"{share:.1%} of the torque at which the whole contact slides")
