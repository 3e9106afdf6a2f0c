"""
Do dual wheels strain a road less than a single wide one?
=========================================================

65 kN on two discs or on one, at the same pressure: strain across travel over the width of the road at the bottom of
the base.
"""

import numpy as np

import treadload as tl

road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
loads = {
    "dual": tl.response.dual_wheels(tl.UniformDisc(0.125, 662e3), 0.375),
    "single": [tl.UniformDisc(0.125 * np.sqrt(2), 662e3)],
}
across = np.linspace(-0.6, 0.6, 121)
figure = tl.plots.new_figure(7.5, 3.6)
axes = figure.subplots()
largest = {}
for name, load in loads.items():
    line = tl.solve_response(load, road, depths=[0.21], x=[0.0], y=across).dataset.squeeze()
    axes.plot(1e3 * across, 1e6 * line.in_plane_strain_1, label=name)
    largest[name] = 1e6 * float(line.in_plane_strain_1.max())
axes.set(xlabel="y, right of travel (mm)", ylabel="largest horizontal strain (microstrain)")
axes.legend(frameon=False)

# %%
# Single over dual:

ratio = largest["single"] / largest["dual"]
print(f"{largest['single']:.0f} over {largest['dual']:.0f} microstrain: {ratio:.2f}")
