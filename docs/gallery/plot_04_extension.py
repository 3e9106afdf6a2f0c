"""
Where the surface is torn, and which way
========================================

Largest tensile strain of the road's surface under a driving wheel. The strokes lie along the strain; a crack opens
across them.
"""

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
wheel = tl.Rolling(normal_load=32.5e3, tractive_force=10e3, friction=0.7)
contact = tl.solve_contact(tire, road, wheel, spacing=6e-3)
response = tl.solve_response(contact, road, depths=[0, 0.01, 0.02, 0.04])

figure = response.plot.strain_directions()

# %%
# The directions of all cracks that the load would open, as a rose:

verdict = tl.assess(response, tl.FatigueLine(epsilon_6=120e-6, slope=-0.2))
rose = verdict.plot.rose()
