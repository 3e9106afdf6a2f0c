"""
How much lateral force does a slip angle give?
==============================================

Lateral force and aligning moment of a tread at 32.5 kN, from the slope at straight travel to full sliding.
"""

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
wheel = tl.Rolling(normal_load=32.5e3, friction=0.7)
slips = (-0.2, -0.1, -0.05, -0.025, 0.0, 0.025, 0.05, 0.1, 0.2)  # tangent of the slip angle
curve = tl.contact.creep_curve(tire, road, wheel, slips, along="y", spacing=10e-3)

figure = tl.plots.creep_curves([curve], ["μ = 0.7"], along="y")

# %%
# The slope at small slip, cornering stiffness over the load:

force = curve.dataset.lateral_force
stiffness = abs(float(force.sel(creepage=0.025))) / 0.025 / 32.5e3
print(f"{stiffness:.2f} of the load per unit of slip")
