"""
Scans: dimensions of a tire from its mesh
=========================================

Radius, width and grooves that the scan of a mesh finds, in any pose. Witness: the dimensions of the mesh.
"""

import treadload as tl
from treadload.validation import run_checks

checks = [check for check in run_checks(names=["mesh"]) if check.quantity.endswith(", mm")]
figure = tl.plots.new_figure(8, 3.8)
axes = figure.subplots()
rows = range(len(checks))
axes.barh(rows, [check.deviation for check in checks], height=0.55)
for row, check in zip(rows, checks, strict=True):
    axes.plot([-check.bound, check.bound], [row, row], "k|", markersize=12)
axes.axvline(0, color="0.3", linewidth=0.8)
axes.set_yticks(rows, [f"{check.quantity} ({check.reference:g})" for check in checks], fontsize=8)
axes.set(xlabel="deviation (mm); marks: bounds, the facets of the mesh")
axes.invert_yaxis()

# %%
# Largest deviation over its bound:

deviation = max(abs(check.deviation) / check.bound for check in checks)
print(f"{deviation:.2f}")
