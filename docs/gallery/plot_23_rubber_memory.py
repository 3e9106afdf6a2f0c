"""
Why does a tire resist rolling?
===============================

A tread of viscoelastic rubber at three speeds: its pressure leads the axle, and the moment of that arm is the
resistance.
"""

import numpy as np

import treadload as tl

rubber = tl.materials.Prony(9e6, ((0.3, 0.003), (0.2, 0.03)), 0.49)  # glassy modulus in Pa; shares and times in s
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
profile = tl.catalogue.tires["315/80R22.5"]
tire = tl.Tire.from_profile(profile, material=rubber)
speeds, coefficients = (1.0, 5.0, 20.0, 80.0), []
for speed in speeds:
    contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=32.5e3, friction=0.7, speed=speed), spacing=12e-3)
    coefficients.append(1e3 * tl.contact.rolling_resistance(contact, profile.rolling_radius).coefficient)
figure = tl.plots.new_figure(6.5, 3.6)
axes = figure.subplots()
axes.semilogx(3.6 * np.array(speeds), coefficients, "o-")
axes.set(xlabel="speed (km/h)", ylabel="rolling resistance of the tread (N/kN)", ylim=(0, None))

# %%
# Largest of the four:

largest = max(coefficients)
print(f"{largest:.1f} N/kN")
