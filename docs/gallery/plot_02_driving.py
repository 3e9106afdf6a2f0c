"""
Stick and slip of a driving wheel
=================================

A driving force of 10 kN against a bound of 0.7 times the load: the rear of the patch slides, the front holds.
"""

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
wheel = tl.Rolling(normal_load=32.5e3, tractive_force=10e3, friction=0.7)
contact = tl.solve_contact(tire, road, wheel, spacing=6e-3)

figure = contact.plot.stick_slip()

# %%
# The creepage that this force needs, and what share of the contact slides:

print(f"creepage {contact.dataset.creepage_x.item():.4f}")
slipping = (contact.dataset.state == 2).sum() / (contact.dataset.state > 0).sum()
print(f"{slipping.item():.0%} of the cells in contact slide")
