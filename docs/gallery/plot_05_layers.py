"""
A structure of the French catalogue
===================================

Strain over depth below one of two dual wheels, at 15 °C and at 35 °C: asphalt softens, and the largest
extension moves.
"""

import treadload as tl

load = [tl.UniformDisc(0.125, 662e3, y=-0.1875), tl.UniformDisc(0.125, 662e3, y=0.1875)]
depths = [0.0, 0.01, 0.02, 0.03, 0.04, 0.06, 0.08, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2, 0.21]
across = [-0.35 + 0.025 * k for k in range(29)]
responses = {}
for temperature in (15, 35):
    road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=temperature)
    responses[temperature] = tl.solve_response(load, road, depths=depths, x=[0.0], y=across)

cold = responses[15].plot.depth_slice(along="across")

# %%
# The same at 35 °C:

warm = responses[35].plot.depth_slice(along="across")
