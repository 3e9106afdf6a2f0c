"""
What does a falling weight show of a road?
==========================================

Deflection bowls of two roads that differ in the subgrade alone: the far sensors distinguish them.
"""

import treadload as tl

plate = tl.UniformDisc(0.15, 50e3 / (3.14159265 * 0.15**2))  # 50 kN on a plate of 300 mm
x = [0.05 * k for k in range(41)]
bowls = {}
for modulus in (50e6, 100e6):
    road = tl.Pavement([
        tl.Layer(tl.Elastic(5e9, 0.35), 0.15),
        tl.Layer(tl.Elastic(300e6, 0.35), 0.30),
        tl.Layer(tl.Elastic(modulus, 0.40)),
    ])  # fmt: skip
    bowls[f"subgrade {modulus / 1e6:.0f} MPa"] = tl.solve_response([plate], road, depths=[0.0], x=x, y=[0.0])

figure = tl.plots.deflection_bowl(list(bowls.values()), list(bowls))

# %%
# Deflection at 1.8 m, which depends on the subgrade almost alone: twice as stiff, half as much.

far = [1e6 * float(bowl.dataset.displacement_z.sel(x=1.8, y=0.0).squeeze()) for bowl in bowls.values()]
ratio = far[0] / far[1]
print(f"{far[0]:.0f} and {far[1]:.0f} µm, ratio {ratio:.2f}")
