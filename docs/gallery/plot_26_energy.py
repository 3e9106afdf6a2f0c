"""
Where does a passing wheel dissipate energy?
============================================

Energy per volume that a disc leaves in viscoelastic asphalt at 10 m/s, over a section across travel.
"""

import numpy as np

import treadload as tl

mix = tl.catalogue.materials["ViscoRoute"].material.at(25.0)
road = tl.Pavement([tl.Layer(mix, 0.15), tl.Layer(tl.Elastic(200e6, 0.35))])
depths = np.linspace(0.01, 0.15, 15)
across = np.linspace(-0.3, 0.3, 31)
solved = tl.solve_response(tl.UniformDisc(0.125, 662e3), road, depths=depths, x=[0.0], y=across, speed=10.0)

figure = solved.plot.dissipated_energy()

# %%
# Largest value:

largest = float(solved.dataset.dissipated_energy.max())
print(f"{largest:.0f} J/m³")
