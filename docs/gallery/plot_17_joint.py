"""
How hard does a wheel press on the edge of a joint?
===================================================

A truck wheel over a sawn joint of 18 mm with broken edges, at thirteen positions of the axle.
"""

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=850e3)
road = tl.Pavement.half_space(tl.Elastic(30e9, 0.2))
wheel = tl.Rolling(normal_load=32.5e3, friction=0.0)
joint = tl.pavement.RoadJoint(0.018, 0.03, 0.006)  # width, depth and chamfer, m
positions = [0.025 * k for k in range(-6, 7)]
crossing = tl.contact.cross_obstacle(tire, road, wheel, joint, positions=positions, spacing=6e-3)

figure = crossing.plot.contacts()

# %%
# Largest pressure at the edges of the joint over that on the plane before it:

data = crossing.dataset
rise = float(data.edge_pressure.max() / data.largest_pressure[0])
print(f"{rise:.2f}")
