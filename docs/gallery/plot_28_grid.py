"""
How fine must the grid be?
==========================

Peak pressure and contact area of one tread on cells of 16 to 3 mm: the area converges, the peak at a rib's edge does
not.
"""

import treadload as tl

tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
wheel = tl.Rolling(normal_load=32.5e3, friction=0.0)
cells = (16e-3, 12e-3, 8e-3, 6e-3, 4e-3, 3e-3)
contacts = [tl.solve_contact(tire, road, wheel, spacing=cell) for cell in cells]
areas = [1e4 * contact.area for contact in contacts]
peaks = [1e-3 * float(contact.dataset.pressure.max()) for contact in contacts]
figure = tl.plots.new_figure(8, 3.4)
left, right = figure.subplots(1, 2)
left.plot([1e3 * cell for cell in cells], areas, "o-")
right.plot([1e3 * cell for cell in cells], peaks, "o-")
left.set(xlabel="spacing (mm)", ylabel="contact area (cm²)", ylim=(0, 700))
right.set(xlabel="spacing (mm)", ylabel="peak pressure (kPa)", ylim=(0, 1700))

# %%
# Change of the area from 4 to 3 mm:

change = areas[-1] / areas[-2] - 1
print(f"{change:+.2%}")
