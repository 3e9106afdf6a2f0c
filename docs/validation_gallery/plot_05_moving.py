"""
Moving loads: deflection at 60 km/h against ELLVA
=================================================

A wheel on viscoelastic asphalt, 300 mm from its path. Witness: ELLVA (Levenberg), which moves the load in jumps of
50 mm.
"""

import numpy as np

import treadload as tl

asphalt = tl.materials.PowerLawCreep(2.5e-11, 1e-8, 1000.0, 0.35, 0.3)
road = tl.Pavement([
    tl.Layer(asphalt, 0.15), tl.Layer(tl.Elastic(2e8, 0.35), 0.6), tl.Layer(tl.Elastic(4e7, 0.4)),
])  # fmt: skip
printed = {
    -1.0: 0.447,
    -0.5: 0.605,
    -0.2: 0.728,
    0.0: 0.786,
    0.05: 0.791,
    0.1: 0.79,
    0.2: 0.774,
    0.5: 0.658,
    1.0: 0.474,
}
x = np.linspace(-1, 1, 41)
solved = tl.solve_response(tl.UniformDisc(0.15, 1.1e6), road, depths=[0.0], x=x, y=[0.3], speed=60 / 3.6)
deflection = 1e3 * solved.dataset.displacement_z.squeeze()

figure = tl.plots.new_figure(7, 3.6)
axes = figure.subplots()
axes.plot(-x, deflection, label="treadload")
axes.plot(list(printed), list(printed.values()), "o", label="ELLVA, printed")
axes.set(xlabel="load ahead of the point (m)", ylabel="deflection (mm)")
axes.invert_yaxis()
axes.legend(frameon=False)

# %%
# Largest deviation; the jumps and the finite path of ELLVA explain up to 2 %:

deviation = max(abs(float(deflection.sel(x=-at, method="nearest")) / value - 1) for at, value in printed.items())
print(f"{deviation:.2%}")
