"""
Bodies: a viscoelastic cylinder against Hunter
==============================================

Pressure of a rigid cylinder that rolls on a standard linear solid: it leads the axle. Witness: Hunter's closed form.
"""

import treadload as tl
from treadload.validation.viscoelastic import hunter_strip

patch, exact = hunter_strip(200)
computed, closed = patch.normal.pressure[0], exact.pressure(patch.x)

figure = tl.plots.new_figure(7, 3.6)
axes = figure.subplots()
axes.plot(patch.x, computed, label="treadload")
axes.plot(patch.x[::5], closed[::5], "o", markersize=3.5, label="Hunter (1961)")
axes.axvline(0, color="0.5", linewidth=0.8, linestyle=":")
axes.set(xlabel="x (m); travel to the right, axle at 0", ylabel="pressure (Pa)")
axes.legend(frameon=False)

# %%
# Deviation of the peak:

deviation = float(computed.max() / closed.max() - 1)
print(f"{deviation:+.1e}")
