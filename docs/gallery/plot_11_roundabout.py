"""
What does a roundabout do to the surface?
=========================================

The same wheel at 10 and at 25 km/h on a path of 20 m: lateral force and turn slip strain the surface.
"""

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
load, radius = 32.5e3, 20.0  # N, m
strains, responses = {}, {}
for speed in (10, 25):  # km/h
    lateral = load / 9.81 * (speed / 3.6) ** 2 / radius
    wheel = tl.Rolling(normal_load=load, friction=0.7, lateral_force=lateral, spin=1 / radius)
    contact = tl.solve_contact(tire, road, wheel, spacing=8e-3)
    response = tl.solve_response(contact, road, depths=[0.0, 0.01])
    responses[f"{speed} km/h"] = response
    strains[speed] = 1e6 * float(response.dataset.in_plane_strain_1.max())

figure = tl.plots.compare_strain(list(responses.values()), list(responses))

# %%
# Largest tensile strain in the plane of the surface:

for speed, strain in strains.items():
    print(f"{speed} km/h: {strain:.0f} microstrain")
