"""
What does one ton more on the axle cost?
========================================

Damage of a dual-wheel axle against its load, over that of 100 kN, at the base and on the subgrade.
"""

import numpy as np

import treadload as tl

road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
laws = {"base": (0.21, "above", tl.FatigueLine(90e-6, -0.2)), "subgrade": (0.21, "below", tl.damage.FrenchSubgrade())}
loads = np.array([80e3, 90e3, 100e3, 110e3, 120e3, 130e3])
damage = {name: [] for name in laws}
for load in loads:
    radius = np.sqrt(load / 4 / (np.pi * 662e3))
    wheels = tl.response.dual_wheels(tl.UniformDisc(radius, 662e3), 0.375)
    for name, (depth, side, law) in laws.items():
        solved = tl.solve_response(wheels, road, depths=[depth], x=[0.0], y=[0.0, 0.1875], side=side).dataset
        strain = float(solved.in_plane_strain_1.max()) if name == "base" else -float(solved.strain_zz.min())
        damage[name].append(1 / float(law.allowable_passes(strain)))
figure = tl.plots.new_figure(7, 3.8)
axes = figure.subplots()
powers = {}
for name, values in damage.items():
    axes.plot(1e-3 * loads, np.array(values) / values[2], "o-", label=name)
    powers[name] = float(np.polyfit(np.log(loads), np.log(values), 1)[0])
axes.set(xlabel="axle load (kN), at constant tire pressure", ylabel="damage over that of 100 kN")
axes.legend(frameon=False)

# %%
# Damage grows with a power of the load:

for name, power in powers.items():
    print(f"{name}: {power:.2f}")
