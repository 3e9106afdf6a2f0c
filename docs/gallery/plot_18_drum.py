"""
When has a roller finished?
===========================

A drum of 2 t on a soft fill that yields: each pass adds less to the track than the one before.
"""

import treadload as tl

profile = tl.tire.TreadProfile(rolling_radius=0.6, crown_radius=1e4, width=1.5, shoulder_radius=0.02)  # m
drum = tl.Tire.from_profile(profile, material=tl.Elastic(210e9, 0.3))
fill = tl.materials.ElastoPlastic(tl.Elastic(15e6, 0.45), tl.materials.VonMises(100e3, hardening=2e6))
road = tl.Pavement([tl.Layer(fill, 0.15, name="fill"), tl.Layer(tl.Elastic(100e6, 0.35), name="base")])
rolled = tl.response.roll_drum(drum, road, 20e3, passes=5, layers=5)

figure = rolled.plot.rut()

# %%
# Plastic strain that the last pass adds, over that of the first:

left = float(rolled.dataset.plastic_increment[-1] / rolled.dataset.plastic_increment[0])
print(f"{left:.1e}")
