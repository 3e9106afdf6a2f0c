"""
How far apart are fatigue laws?
===============================

Allowable load repetitions against the strain at the bottom of 15 cm of asphalt of 5 GPa, by five laws.
"""

import numpy as np

import treadload as tl

laws = {
    "Asphalt Institute": tl.damage.AsphaltInstitute(5e9),
    "Shell": tl.damage.ShellFatigue(5e9),
    "MEPDG, bottom-up": tl.damage.MepdgBottomUp(5e9, 0.15, 0.06, 0.11),
    "IRC:37": tl.damage.IrcFatigue(5e9, air_voids=0.035, binder_volume=0.115),
    "French, GB3, risk 5 %": tl.damage.FrenchBituminous(90e-6, -0.2, 0.3, 0.15, 0.05, 1.3, 11880 / 9000, 120e6),
}
strains = np.geomspace(50e-6, 400e-6, 40)
figure = tl.plots.new_figure(7.5, 4)
axes = figure.subplots()
at_hundred = {}
for name, law in laws.items():
    axes.loglog(1e6 * strains, [float(law.allowable_passes(strain)) for strain in strains], label=name)
    at_hundred[name] = float(law.allowable_passes(100e-6))
axes.set(xlabel="tensile strain (microstrain)", ylabel="allowable load repetitions")
axes.legend(frameon=False)

# %%
# At 100 microstrain, largest over smallest:

spread = max(at_hundred.values()) / min(at_hundred.values())
print(f"{spread:.0f} times")
