"""
Pressure under a truck tire
===========================

A parametric tread of the library, pressed onto asphalt and rolled freely.
"""

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)  # Pa
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))  # modulus in Pa, Poisson's ratio
contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=32.5e3, friction=0.7), spacing=5e-3)
print(contact.summary())

figure = contact.plot.pressure()

# %%
# Along travel and across it: each rib carries its own parabola, highest at its edges.

profiles = contact.plot.profile()
